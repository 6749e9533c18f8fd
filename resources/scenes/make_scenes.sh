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

# Spheres along the first 14 cm of a probe, dense near the tip.
probe_spheres() { awk 'BEGIN { for (z = 0.0025; z < 0.14; z += z < 0.05 ? 0.002 : 0.004) print 0, 0, z, 0.0025 }'; }

# Input for the right probe: it turns about the place where it enters the body, and its tip follows points in time.
probe_track() {
  awk 'function ease(x) { return x * x * (3 - 2 * x) }
    { time[NR] = $1; x[NR] = $2; y[NR] = $3; z[NR] = $4 }
    END {
      print "spore-track 1\ndevice probe"
      k = 1
      for (n = 0; n <= 50 * time[NR]; n++) {
        t = n / 50
        while (k < NR - 1 && t >= time[k + 1]) k++
        s = ease((t - time[k]) / (time[k + 1] - time[k]))
        px = x[k] + s * (x[k + 1] - x[k]); py = y[k] + s * (y[k + 1] - y[k]); pz = z[k] + s * (z[k + 1] - z[k])
        dx = 0.105 - px; dy = 0.045 - py; dz = 0.190 - pz
        length_m = sqrt(dx * dx + dy * dy + dz * dz)
        w = 1 + dz / length_m; qx = -dy / length_m; qy = dx / length_m
        norm = sqrt(w * w + qx * qx + qy * qy)
        printf "%.2f %.6f %.6f %.6f %.7f %.7f %.7f 0 0 0\n", t, px, py, pz, w / norm, qx / norm, qy / norm
      }
    }' <<'POINTS'
0.0 0.088 0.058 0.075
0.5 0.086 0.054 0.070
1.3 0.062 0.024 0.030
1.9 0.056 0.013 0.008
2.3 0.056 0.013 0.008
3.0 0.066 0.026 0.032
3.6 0.062 -0.010 0.030
4.0 0.056 -0.012 0.006
4.7 0.054 0.012 0.004
5.2 0.054 0.012 0.004
6.0 0.060 -0.010 0.030
7.0 0.088 0.058 0.075
POINTS
}

/usr/bin/python3 ../meshes/make_organs.py laparoscopy
/usr/bin/python3 ../meshes/make_minimal.py minimal
lattice >minimal/floor.spheres
echo "0 0 0 0.02" >minimal/ball.spheres
probe_spheres >laparoscopy/probe.spheres
probe_track >laparoscopy/laparoscopy.track
"$spore" spheres --quiet laparoscopy/uterus.off --count 110 -o laparoscopy/uterus.spheres
for side in left right; do
  "$spore" spheres --quiet laparoscopy/ovary_$side.off --count 60 -o laparoscopy/ovary_$side.spheres
  "$spore" tetrahedra --quiet laparoscopy/ovary_$side.off --cells 450 -o laparoscopy/ovary_$side.mesh
done
