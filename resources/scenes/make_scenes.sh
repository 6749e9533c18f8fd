#!/bin/sh
# Makes the assets of the shipped scenes anew: meshes, collision spheres, tetrahedra and recorded input. The scenes
# themselves (*.spore) are written by hand. Needs a built spore, and Python with numpy.
#
#   resources/scenes/make_scenes.sh [build/app/spore]
set -eu
cd "$(dirname "$0")"
spore=${1:-../../build/app/spore}
case $spore in /*) ;; *) [ -x "$spore" ] || spore=../../$spore ;; esac

lattice() { awk 'BEGIN { for (i = -5; i <= 5; i++) for (j = -5; j <= 5; j++) print i / 100, -0.015, j / 100, 0.015 }'; }

# Spheres along the first centimetres of a shaft, dense near the tip: RADIUS LENGTH DENSE NEAR FAR.
shaft_spheres() {
  awk -v r="$1" -v length_m="$2" -v dense="$3" -v near="$4" -v far="$5" \
    'BEGIN { for (z = r; z < length_m; z += z < dense ? near : far) print 0, 0, z, r }'
}

/usr/bin/python3 ../meshes/make_organs.py organs instruments
/usr/bin/python3 ../meshes/make_minimal.py minimal
/usr/bin/python3 ../meshes/make_tissue.py organs table1
/usr/bin/python3 ../meshes/make_bag.py bag
/usr/bin/python3 ../meshes/make_adnexa.py exercise-salpingectomy
/usr/bin/python3 ../meshes/make_pegs.py exercise-peg-transfer
/usr/bin/python3 ../meshes/make_tube.py exercise-clip-and-cut
/usr/bin/python3 ../meshes/make_dish.py exercise-suction
/usr/bin/python3 ../meshes/make_laparoscopy.py laparoscopy
/usr/bin/python3 ../meshes/make_knot.py knot
/usr/bin/python3 ../meshes/make_suture.py suture instruments
/usr/bin/python3 ../meshes/make_tracks.py .
lattice >minimal/floor.spheres
echo "0 0 0 0.02" >minimal/ball.spheres
shaft_spheres 0.0025 0.14 0.05 0.002 0.004 >instruments/probe.spheres
for side in upper lower; do
  awk -v y="$([ $side = upper ] && echo 0.0015 || echo -0.0015)" \
    'BEGIN { for (z = 0.0015; z < 0.017; z += 0.0015) print 0, y, -z, 0.0015 }' >instruments/jaw_$side.spheres
done
shaft_spheres 0.005 0.16 0.03 0.003 0.006 >instruments/endoscope.spheres
"$spore" spheres --quiet organs/uterus.off --count 110 -o organs/uterus.spheres
for side in left right; do
  "$spore" spheres --quiet "organs/ovary_$side.off" --count 60 -o "organs/ovary_$side.spheres"
  "$spore" tetrahedra --quiet "organs/ovary_$side.off" --cells 450 -o "organs/ovary_$side.mesh"
  "$spore" spheres --quiet "organs/tube_$side.off" --count 50 -o "organs/tube_$side.spheres"
  "$spore" tetrahedra --quiet "organs/tube_$side.off" --cells 900 -o "organs/tube_$side.mesh"
done
"$spore" tetrahedra --quiet organs/ovary_right.off --cells 1600 -o cut-ovary/ovary.mesh
"$spore" tetrahedra --quiet exercise-clip-and-cut/tube.off --cells 900 -o exercise-clip-and-cut/tube.mesh
/usr/bin/python3 ../meshes/make_intestine.py organs plate6-intestine 0.70 5 4
/usr/bin/python3 ../meshes/make_intestine.py organs laparoscopy 0.815 3 2
