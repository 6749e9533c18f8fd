#!/bin/sh
# embed.sh SOURCE BUILD: installs the library and its headers into a folder of their own, and builds and runs
# resources/examples there as a stranger would, by make and pkg-config. Looks at what the library needs. Speaks TAP.
set -u
source=$1 build=$2
stage=$(mktemp -d) || exit 1
trap 'rm -rf "$stage"' EXIT
echo 1..8

# check NUMBER NAME COMMAND...: what the command prints is shown as comments.
check() {
  number=$1 name=$2
  shift 2
  if "$@" >"$stage/said" 2>&1; then echo "ok $number - $name"; else echo "not ok $number - $name"; fi
  sed 's/^/# /' "$stage/said"
}

needs_libc_alone() {
  needed=$(readelf -d "$library" "$stage/embed/embed" "$stage/play/play" "$build/app/spore-player" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
    grep -Ev '^(libspore\.so|libc\.so|libm\.so|libpthread\.so|ld-linux)' | sort -u)
  [ -z "$needed" ] || { echo "needs $needed"; return 1; }
}

# state COMMAND...: the hash that its JSON says.
state() { "$@" --json | grep -o '"state_hash" *: *"[0-9a-f]*"' | tr -d ' '; }

same_state() {
  played=$(state "$build/app/spore-player" "$stage/scene.run" --steps 300) run=$(state "$build/app/spore" run "$scene" --dt 0.001 -n 300)
  echo "$played $run"
  [ -n "$played" ] && [ "$played" = "$run" ]
}

check 1 "the library is installed" meson install -C "$build" --no-rebuild --quiet --destdir "$stage/root" --tags runtime,devel
library=$(find "$stage/root" -name libspore.so)
folder=$(dirname "$library")
cp -R "$source/resources/examples/embed" "$stage/embed"
cp -R "$source/resources/examples/play" "$stage/play"
export PKG_CONFIG_SYSROOT_DIR="$stage/root" PKG_CONFIG_PATH="$folder/pkgconfig" LD_LIBRARY_PATH="$folder"
check 2 "the example compiles against what is installed" env CFLAGS=-Werror make -C "$stage/embed" embed
check 3 "the example runs" "$stage/embed/embed"
check 4 "an example that plays a scene compiles" env CFLAGS=-Werror make -C "$stage/play" play
scene=$source/resources/scenes/plate1-ovary.spore
check 5 "a scene is exported" "$build/app/spore" export "$scene" --format runtime -o "$stage/scene.run" --dt 0.001
check 6 "the example plays it, with a device of its own, and reads its meshes" "$stage/play/play" "$stage/scene.run" probe
check 7 "the player comes to the state of spore run" same_state
check 8 "library, examples and player need libc and libm alone" needs_libc_alone
