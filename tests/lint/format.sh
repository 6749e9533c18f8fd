#!/bin/sh
# format.sh: checks that clang-format would leave every C and C++ source as it is, and that shellcheck has nothing to say
# of the scripts. `clang-format -i FILE` mends the first.
set -eu
cd "$(dirname "$0")/../.."
status=0
find app core models resources tests ui \( -name '*.[ch]' -o -name '*.[ch]pp' \) -print0 |
  xargs -0 -P 2 -n 50 clang-format --dry-run -Werror || status=1
find dev .ci/run resources tests -type f \( -name '*.sh' -o -name dev -o -name run \) -print0 | xargs -0 shellcheck || status=1
exit $status
