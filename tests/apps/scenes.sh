# Scenes for the tests of the command line; sourced.
pendulum() {  # pendulum END_TIME
  cat <<EOF
{"schema_version": 1, "title": "pendulum", "gravity": [0, 0, -9.81],
 "bodies": [{"name": "bob", "kind": "point_mass", "mass": 1, "position": [1, 0, 0]}],
 "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0], "axis": [0, 1, 0]}],
 "sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
 "analysis": {"kind": "dynamic", "end_time": $1, "step_size": 0.01},
 "output": {"motion": true, "motion_stride": 10}}
EOF
}
