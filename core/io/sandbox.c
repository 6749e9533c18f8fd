/* The sandbox that a helper enters before it reads untrusted bytes: it gives up files, processes and network. Needs
 * libc alone. */
#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/io/helper.h"

#define FIRST_UNUSED_FILE 4 /* 0: request, 1 and 2: printed text of libraries, 3: frames */

#if defined(__x86_64__)
#define ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

/* As in linux/landlock.h. That structure grows from version to version; with a definition of our own, an older header
 * does not keep us from using a newer kernel. */
struct landlock_rules {
  uint64_t files, network, scoped;
};

/* A Landlock ruleset that handles every right of this kernel and grants none. */
static bool forbid_files(void) {
  long version = syscall(SYS_landlock_create_ruleset, NULL, 0, 1 /* LANDLOCK_CREATE_RULESET_VERSION */);
  if (version < 1) return false;
  int rights = version >= 5 ? 16 : version >= 3 ? 15 : version == 2 ? 14 : 13; /* one bit each */
  struct landlock_rules rules = {.files = (UINT64_C(1) << rights) - 1};
  rules.network = 3; /* TCP bind and connect, from version 4 */
  rules.scoped = 3;  /* abstract sockets and signals, from version 6 */
  size_t size = version >= 6 ? 24 : version >= 4 ? 16 : 8;
  int file = (int)syscall(SYS_landlock_create_ruleset, &rules, size, 0);
  if (file < 0) return false;
  bool done = syscall(SYS_landlock_restrict_self, file, 0) == 0;
  close(file);
  return done;
}

#ifdef ARCHITECTURE
/* System calls that computing needs: memory, the open pipes, time, signals to itself, ending. No call opens, connects,
 * forks, executes or looks at other processes. */
static const uint16_t allowed_calls[] = {
    SYS_read,
    SYS_write,
    SYS_writev,
    SYS_close,
    SYS_lseek,
    SYS_fstat,
    SYS_mmap,
    SYS_munmap,
    SYS_mremap,
    SYS_mprotect,
    SYS_madvise,
    SYS_brk,
    SYS_futex,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_sigaltstack,
    SYS_clock_gettime,
    SYS_clock_nanosleep,
    SYS_nanosleep,
    SYS_gettimeofday,
    SYS_getrandom,
    SYS_getpid,
    SYS_gettid,
    SYS_sched_yield,
    SYS_getrusage,
    SYS_sysinfo,
    SYS_sched_getaffinity,
    SYS_restart_syscall,
    SYS_exit,
    SYS_exit_group,
};
#define CALLS (sizeof allowed_calls / sizeof *allowed_calls)

/* Every other call fails with EPERM and does not kill the process: libraries try optional calls and handle the failure.
 */
static bool forbid_calls(void) {
  struct sock_filter filter[CALLS + 6], *next = filter;
  *next++ = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, arch));
  *next++ = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, ARCHITECTURE, 1, 0);
  *next++ = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS);
  *next++ = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
  for (size_t i = 0; i < CALLS; i++) /* to the last statement; the x32 numbers of x86-64 match none */
    *next++ = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, allowed_calls[i], (uint8_t)(CALLS - i), 0);
  *next++ = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
  *next++ = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  struct sock_fprog program = {(unsigned short)(next - filter), filter};
  return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}
#else
static bool forbid_calls(void) { return false; }
#endif

static void limit(int what, uint64_t value) {
  setrlimit((__rlimit_resource_t)what, &(struct rlimit){.rlim_cur = value, .rlim_max = value});
}

gboolean spore_sandbox_enter(guint64 memory, guint64 processor_s, const char **missing) {
  close_range(FIRST_UNUSED_FILE, ~0u, 0);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
#ifndef __SANITIZE_ADDRESS__ /* the sanitizer maps terabytes for its own bookkeeping */
  limit(RLIMIT_AS, memory);
#endif
  limit(RLIMIT_CPU, processor_s);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_NPROC, 0);
  bool files = forbid_files();
  limit(RLIMIT_NOFILE, FIRST_UNUSED_FILE);
  bool calls = forbid_calls();
  *missing = !files && !calls ? "Landlock, seccomp" : !files ? "Landlock" : !calls ? "seccomp" : NULL;
  return *missing == NULL;
}
