#!/bin/sh
# embed.sh SOURCE BUILD: installs the library and its headers into a folder of their own, and builds and runs
# resources/examples/embed there as a stranger would, by make and pkg-config. Looks at what the library needs. Speaks TAP.
set -u
source=$1 build=$2
stage=$(mktemp -d) || exit 1
trap 'rm -rf "$stage"' EXIT
echo 1..4

# check NUMBER NAME COMMAND...: what the command prints is shown as comments.
check() {
  number=$1 name=$2
  shift 2
  if "$@" >"$stage/said" 2>&1; then echo "ok $number - $name"; else echo "not ok $number - $name"; fi
  sed 's/^/# /' "$stage/said"
}

needs_libc_alone() {
  needed=$(readelf -d "$library" "$stage/embed/embed" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
    grep -Ev '^(libspore\.so|libc\.so|libm\.so|libpthread\.so|ld-linux)' | sort -u)
  [ -z "$needed" ] || { echo "needs $needed"; return 1; }
}

check 1 "the library is installed" meson install -C "$build" --no-rebuild --quiet --destdir "$stage/root" --tags runtime,devel
library=$(find "$stage/root" -name libspore.so)
folder=$(dirname "$library")
cp -R "$source/resources/examples/embed" "$stage/embed"
export PKG_CONFIG_SYSROOT_DIR="$stage/root" PKG_CONFIG_PATH="$folder/pkgconfig" LD_LIBRARY_PATH="$folder"
check 2 "the example compiles against what is installed" env CFLAGS=-Werror make -C "$stage/embed" embed
check 3 "the example runs" "$stage/embed/embed"
check 4 "library and example need libc and libm alone" needs_libc_alone
