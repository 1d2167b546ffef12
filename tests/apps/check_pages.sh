#!/bin/sh
# check_pages.sh PROGRAM SOURCE   opens pages of runs and of the extreme cases in a headless browser: no error on the console, no texts that
# overlap or lie on what is drawn, no columns cut, nothing blown up, at several widths and on paper. Exit status 77: there is no browser.
set -u
program=$(realpath "$1")
source=$(realpath "$2")
browser=$(command -v chromium || command -v google-chrome || command -v chromium-browser || true)
[ -n "$browser" ] || { echo "no chromium found"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
# Every kind of thing that the legend of a motion names, a sensor with a long name, and little motion above the legend.
cat > parts.json << 'SCENE'
{"schema_version": 1, "gravity": [0, -9.81, 0],
 "sections": [{"name": "s", "stiffness": {"EA": 1e5, "GA2": 1e5, "GA3": 1e5, "GJ": 10, "EI2": 10, "EI3": 10},
               "mass": {"mass_per_length": 1, "rotary": [1e-3, 1e-3, 1e-3]}}],
 "nodes": [{"name": "root"}, {"name": "tip", "position": [2, 0, 0]}],
 "bodies": [{"name": "block", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [2.5, 0, 0]}],
 "beams": [{"name": "beam", "section": "s", "start": "root", "end": "tip", "elements": 4}],
 "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "root", "position": [0, 0, 0]},
            {"name": "hinge", "kind": "revolute", "first": "tip", "second": "block", "position": [2, 0, 0], "axis": [0, 0, 1]}],
 "springs": [{"name": "coil", "first": "block", "second": {"to": "ground", "position": [2.5, 1, 0]}, "stiffness": 40}],
 "sensors": [{"name": "reaction of the wall on the root of the beam", "kind": "joint_reaction", "joint": "wall"}],
 "analysis": {"kind": "dynamic", "end_time": 0.012345, "step_size": 1e-3}}
SCENE
sed 's/"sensors": \[.*/"sensors": [{"name": "angle", "kind": "joint_angle", "joint": "hinge"}],/' parts.json > one_plot.json
"$program" run parts.json --out parts --set /output/motion=true --quiet && "$program" view parts > /dev/null || exit 1
"$program" run one_plot.json --out one_plot --set /output/motion=true --quiet && "$program" view one_plot > /dev/null || exit 1
"$program" stress --case condition --out stress --quiet || exit 1
sh "$source/tests/tools/check_html.sh" parts/view.html one_plot/view.html stress/stress.html
