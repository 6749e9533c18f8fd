#!/bin/sh
# Makes the pictures of the templates on the editor's first page, at twice their size on the screen.
#     make_templates.sh SPORE
set -eu
spore=$(realpath "$1")
cd "$(dirname "$0")"
while read -r name scene time; do
  "$spore" render --quiet "../scenes/$scene.spore" --time "$time" --size 256x144 -o "templates/$name.png"
done <<END
organ plate4-deformed-ovary 0.6
thread plate5-string 0.4
fluid plate3-blood 0.8
net plate2-tissue 0.5
instrument plate8-clamp 1.2
effect plate7-steam 2.4
END
