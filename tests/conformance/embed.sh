#!/bin/sh
# embed.sh SOURCE BUILD LIBRARY HEADER...: builds embed.c as a stranger would, against the headers that are installed and
# the pkg-config file, with libc and libm alone; runs it; and looks at what the library itself needs. Speaks TAP.
set -u
source=$1 build=$2 library=$3
shift 3
stage=$(mktemp -d) || exit 1
trap 'rm -rf "$stage"' EXIT
echo 1..3

for header in "$@"; do
  mkdir -p "$stage/spore-1/$(dirname "$header")" && cp "$source/$header" "$stage/spore-1/$header"
done
cp "$source/models/spore.h" "$stage/spore-1/spore.h"

export PKG_CONFIG_PATH="$build/meson-private"
flags=$(pkg-config --define-variable=includedir="$stage" --cflags spore)
if ${CC:-cc} -std=c17 -Wall -Wextra -Werror -o "$stage/embed" "$source/tests/conformance/embed.c" $flags \
    -L"$(dirname "$library")" -Wl,-rpath,"$(dirname "$library")" -lspore -lm; then
  echo "ok 1 - compiles against the installed headers"
else
  echo "not ok 1 - compiles against the installed headers"
fi
if "$stage/embed" >"$stage/said"; then echo "ok 2 - runs"; else echo "not ok 2 - runs"; fi
sed 's/^/# /' "$stage/said"

needed=$(readelf -d "$library" "$stage/embed" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
  grep -Ev '^(libspore\.so|libc\.so|libm\.so|libpthread\.so|ld-linux)' | sort -u)
if [ -z "$needed" ]; then echo "ok 3 - needs libc and libm alone"; else echo "not ok 3 - needs $needed too"; fi
