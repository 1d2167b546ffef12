// Every case spoils the base scene in one place. '@' marks where the problem has to be reported; it is taken out
// before reading.
#include <gtest/gtest.h>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"
#include "scene_base.hpp"
#include "scene_table_cases.hpp"
#include "support/untrapped.hpp"

namespace bough::io {
namespace {

using test::Bad;
using test::table_cases;

// Text, geometry and references: what only the reader sees.
const Bad scene_cases[] = {
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"actuators\": [ { \"name\": @\"left motor\", \"kind\": \"servo\", \"joint\": \"hinge\", "
     "\"target\": 1, \"position_gain\": 1 } ],",
     "/actuators/0/name", "formulas cannot call a signal by this name"},
    {"\"title\": \"base\",", "\"title\": \"base\", @\"title\": \"again\",", "/title", "given before"},
    {"\"mass\": 2, ", "\"mass\": 2, @\"mass\": 3, ", "/bodies/0/mass", "given before"},
    {"\"stiffness\": 10 }", "\"stiffness\": @1e-400 }", "/springs/0/stiffness", "too small for a double"},
    {"\"kind\": \"rectangle\", \"width\": 0.02, \"height\": 0.04",
     "\"kind\": \"tube\", \"outer_radius\": 1, \"inner_radius\": @1", "/sections/0/shape/inner_radius",
     "below the outer radius"},
    {"\"material\": \"steel\"", "\"material\": @\"steal\"", "/sections/0/material", "did you mean \"steel\"?"},
    {"{ \"axis\": [0, 0, 1], \"angle\": 0.5 }", "{ \"axis\": @[0, 0, 0], \"angle\": 0.5 }", "/frames/0/rotation/axis",
     "length other than 0"},
    {"{ \"axis\": [0, 0, 1], \"angle\": 0.5 }", "{ \"quaternion\": @[1, 1, 0, 0] }", "/frames/0/rotation/quaternion",
     "length 1"},
    {"{ \"axis\": [0, 0, 1], \"angle\": 0.5 }", "{ \"axes\": @{ \"1\": [1, 0, 0] } }", "/frames/0/rotation/axes",
     "exactly two"},
    {"{ \"axis\": [0, 0, 1], \"angle\": 0.5 }", "{ \"axes\": @{ \"1\": [1, 0, 0], \"2\": [2, 0, 0] } }",
     "/frames/0/rotation/axes", "parallel"},
    {"\"name\": \"bench\", ", "\"name\": \"bench\", \"frame\": @\"bench\", ", "/frames/0/frame", "stands in itself"},
    {"\"name\": \"bench\", ", "\"name\": \"bench\", \"frame\": @\"bank\", ", "/frames/0/frame",
     "no frame has this name"},
    {"\"name\": \"knee\", ", "\"name\": \"knee\", \"frame\": @\"root\", ", "/nodes/1/frame", "this is not a frame"},
    {"\"name\": \"rubber\"", "\"name\": @\"knee\"", "/bushings/0/name", "taken already"},
    {"\"EI3\": 30 }, \"mass\"", "\"EI3\": 30 }, \"damping\": @[-1, 0, 0, 0, 0, 0], \"mass\"", "/sections/1/damping",
     "at least 0"},
    {"{ \"mass_per_length\": 2, \"rotary\": [0.2, 0.1, 0.1] }", "@[2, 2, 2, 0.2, -0.1, 0.1]", "/sections/1/mass",
     "at least 0"},
    {"{ \"EA\": 1e6, \"GA2\": 1e6, \"GA3\": 1e6, \"GJ\": 10, \"EI2\": 20, \"EI3\": 30 }",
     "@[[1,0,0,0,0,2],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[2,0,0,0,0,1]]", "/sections/1/stiffness",
     "not positive definite"},
    {"{ \"EA\": 1e6, \"GA2\": 1e6, \"GA3\": 1e6, \"GJ\": 10, \"EI2\": 20, \"EI3\": 30 }",
     "@[[1,0.5,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]",
     "/sections/1/stiffness", "not symmetric"},
    {"[0.1, 0.2, 0.25]", "@[0.1, 0.2, 0.35]", "/bodies/0/inertia", "exceeds the sum of the others"},
    {"[0.1, 0.2, 0.25]", "@[[0.1, 0.3, 0], [0.3, 0.1, 0], [0, 0, 0.1]]", "/bodies/0/inertia", "not negative"},
    {"[0.1, 0.2, 0.25]", "@[[0.1, 0.01, 0], [0, 0.1, 0], [0, 0, 0.1]]", "/bodies/0/inertia", "symmetric"},
    {"{ \"name\": \"cart\", \"mass\": 2, \"inertia\": [0.1, 0.2, 0.25],", "@{ \"name\": \"cart\", \"mass\": 2,",
     "/bodies/0", "exactly one of the keys \"inertia\" or \"shape\""},
    {"{ \"name\": \"bob\", \"kind\": \"point_mass\", \"mass\": 0.5,", "@{ \"name\": \"bob\", \"kind\": \"point_mass\",",
     "/bodies/1", "needs the key \"mass\""},
    {"\"inertia\": [0.1, 0.2, 0.25]", "\"shape\": { \"kind\": \"box\", \"size\": [0, 1, 1] }", "/bodies/0/shape/size/0",
     "above 0"},
    {"\"section\": \"bar\"", "\"section\": @\"baar\"", "/beams/0/section", "did you mean \"bar\"?"},
    {"\"start\": \"root\"", "\"start\": @\"rot\"", "/beams/0/start", "did you mean \"root\"?"},
    {"\"start\": \"root\"", "\"start\": @\"ground\"", "/beams/0/start", "not the ground"},
    {"\"start\": \"root\"", "\"start\": @\"bench\"", "/beams/0/start", "not a node or body"},
    {"\"start\": \"root\"", "\"start\": @\"lower.1\"", "/beams/0/start", "not at an inner node"},
    {"\"start\": \"root\", \"end\": \"knee\"", "\"start\": \"root\", \"end\": @\"root\"", "/beams/0/end", "length 0"},
    {"\"axis_2\": [0, 1, 0]", "\"axis_2\": @[1, 0, 0]", "/beams/0/axis_2", "runs along the beam"},
    {"\"axis_2\": [0, 1, 0]", "\"axis_2\": @[0, 0, 0]", "/beams/0/axis_2", "length other than 0"},
    {"\"axis_2\": [0, 1, 0], \"elements\": 4", "\"end\": \"knee\"", "/beams/0/end", "given before"},
    {"\"start\": \"root\", \"end\": \"knee\",",
     "\"start\": \"root\", \"end\": @\"knee\", \"curve\": { \"curvature\": [0, 0, 1], \"length\": 1, \"tangent\": [1, "
     "0, 0] },",
     "/beams/0/end", "m away from this end"},
    {"\"name\": \"clamp\", \"kind\": \"fixed\", \"first\": \"ground\"",
     "\"name\": \"clamp\", \"kind\": \"fixed\", \"first\": \"root\"", "/joints/0/second", "the same thing"},
    {"\"second\": \"bob\"", "\"second\": @\"bobb\"", "/joints/2/second", "did you mean \"bob\"?"},
    {"\"second\": \"bob\"", "\"second\": @\"lower.9\"", "/joints/2/second", "numbered 0 to 4"},
    {"\"second\": \"bob\"", "\"second\": @\"lower\"", "/joints/2/second", "name one of its ends"},
    {"\"axis\": [0, 1, 0], \"forces\"", "\"axis\": @[0, 0, 0], \"forces\"", "/joints/2/axis", "length other than 0"},
    {"\"position\": [0, 2, 0], \"axis\": [0, 1, 0], \"forces\"", "\"position\": [0, 2, 0], \"forces\"", "/joints/2",
     "needs the key \"axis\""},
    {"\"position\": [0, 2, 0], \"axis\": [0, 1, 0], \"forces\"", "\"axis\": [0, 1, 0], \"forces\"", "/joints/2",
     "needs a position"},
    {"\"second\": \"bob\", \"position\": [0, 2, 0]",
     "\"second\": { \"to\": \"bob\", \"position\": [0, 0, 1] }, \"position\": @[0, 2, 0]", "/joints/2/position",
     "one of the two"},
    {"\"first\": \"cart\", \"second\": \"bob\", \"position\": [0, 2, 0]",
     "\"first\": { \"to\": \"cart\", \"position\": [0, 0, 0] }, \"second\": { \"to\": \"bob\", \"position\": [0, 0, "
     "0.9] }",
     "/joints/2", "0.1 m apart"},
    {"\"damping\": 0.1", "\"coordinate\": @\"displacement\"", "/joints/2/forces/0/coordinate", "\"angle\" only"},
    {"\"forces\": [ { \"damping\": 0.1 } ]", "\"drives\": [ { \"law\": 0 }, @{ \"law\": 0 } ]", "/joints/2/drives/1",
     "driven twice"},
    {"\"kind\": \"fixed\", \"first\": \"ground\", \"second\": \"root\"",
     "\"kind\": \"fixed\", \"first\": \"ground\", \"second\": \"root\", \"drives\": [ @{ \"law\": 0 } ]",
     "/joints/0/drives/0", "no coordinate"},
    {"\"kind\": \"prismatic\", \"first\"", "\"kind\": \"prismatic\", \"pitch\": @0.1, \"first\"", "/joints/1/pitch",
     "only a screw"},
    {"\"kind\": \"prismatic\", \"first\"", "\"kind\": \"screw\", \"first\"", "/joints/1", "needs a pitch"},
    {"\"kind\": \"prismatic\", \"first\"",
     "\"kind\": \"constant_velocity\", \"drives\": [ @{ \"law\": 0 } ], \"first\"", "/joints/1/drives/0",
     "a constant_velocity joint has no coordinate"},
    {"\"kind\": \"prismatic\", \"first\": \"ground\", \"second\": \"cart\", \"position\": [0, 2, 0], \"axis\": [1, 0, "
     "0]",
     "\"kind\": \"distance\", \"first\": { \"to\": \"ground\", \"position\": [0, 2, 0] }, \"second\": \"cart\"",
     "/joints/1", "coincide at the start"},
    {"\"kind\": \"prismatic\", \"first\": \"ground\", \"second\": \"cart\", \"position\": [0, 2, 0], \"axis\": [1, 0, "
     "0]",
     "\"kind\": \"distance\", \"first\": \"ground\", \"second\": \"cart\", \"position\": @[0, 2, 0]",
     "/joints/1/position", "no common frame"},
    {"\"kind\": \"prismatic\", \"first\": \"ground\", \"second\": \"cart\", \"position\": [0, 2, 0], \"axis\": [1, 0, "
     "0]",
     "\"kind\": \"distance\", \"first\": \"ground\", \"second\": \"cart\", \"forces\": [ @{ \"damping\": 1 } ]",
     "/joints/1/forces/0", "a force along it moves nothing"},
    {"\"name\": \"coil\", \"first\": \"tip\", \"second\": \"cart\"",
     "\"name\": \"coil\", \"first\": \"tip\", \"second\": @{ \"to\": \"cart\", \"position\": [1, -2, -1] }",
     "/springs/0/second", "coincide at the start"},
    {"\"at\": \"tip\", \"force\"", "\"at\": @\"ground\", \"force\"", "/loads/0/at", "not the ground"},
    {"{ \"kind\": \"ramp\", \"end_time\": 0.5 }", "{ \"expression\": @\"sin(t\" }", "/loads/0/law/expression",
     "character"},
    {"{ \"kind\": \"ramp\", \"end_time\": 0.5 }", "@{ \"kind\": \"ramp\", \"start_time\": 1, \"end_time\": 0.5 }",
     "/loads/0/law", "t"},
    {"{ \"kind\": \"ramp\", \"end_time\": 0.5 }", "@{ \"expression\": \"1/t\" }", "/loads/0/law",
     "not finite at t = 0"},
    {"\"beam\": \"upper\", \"force\"", "\"beam\": @\"uper\", \"force\"", "/loads/1/beam", "did you mean \"upper\"?"},
    {"\"motions\": [ ]", "\"motions\": [ @{ \"at\": \"knee\" } ]", "/motions/0", "prescribes nothing"},
    {"\"motions\": [ ]", "\"motions\": [ { \"at\": \"knee\", \"x\": 0 }, { \"at\": \"knee\", \"x\": @0 } ]",
     "/motions/1/x", "prescribed twice"},
    {"\"of\": \"cart\"", "\"of\": @\"card\"", "/initial_velocities/0/of", "did you mean \"cart\"?"},
    {"\"joint\": \"hinge\"", "\"joint\": @\"rail\"", "/sensors/2/joint", "no angle"},
    {"\"joint\": \"hinge\"", "\"joint\": @\"hing\"", "/sensors/2/joint", "did you mean \"hinge\"?"},
    {"\"spectral_radius\": 0.9", "\"spectral_radius\": @1", "/analysis/spectral_radius", "below 1"},
    {"\"spectral_radius\": 0.9", "\"integrator\": \"variational\", \"newton\": @\"single\"", "/analysis/newton",
     "solved steps"},
    {"\"spectral_radius\": 0.9", "\"integrator\": \"variational\", \"step_control\": @{}", "/analysis/step_control",
     "its steps are equal"},
    {"\"spectral_radius\": 0.9", "\"integrator\": \"bdf\", \"step_control\": @{}", "/analysis/step_control",
     "steps of equal size"},
    {"\"spectral_radius\": 0.9", "\"integrator\": \"bdf\", \"newton\": @\"single\"", "/analysis/newton",
     "to convergence"},
    {"\"spectral_radius\": 0.9", "\"step_control\": {}, \"newton\": @\"single\"", "/analysis/newton",
     "solved to convergence"},
    {"\"step_size\": 1e-3", "\"step_size\": @2", "/analysis/step_size", "longer than the whole"},
    {"\"step_size\": 1e-3", "\"step_size\": @1e-19", "/analysis/step_size", "more than 1e15 cannot be counted"},
    {"\"quantity\": \"tip.x\"", "\"quantity\": @\"tp.x\"", "/expected/0/quantity", "did you mean \"tip\"?"},
    {"\"quantity\": \"tip.x\"", "\"quantity\": @\"tip\"", "/expected/0/quantity", "components x, y, z"},
    {"\"quantity\": \"tip.x\"", "\"quantity\": @\"tip.w\"", "/expected/0/quantity", "components x, y, z"},
    {"\"quantity\": \"tip.x\"", "\"quantity\": @\"energy.x\"", "/expected/0/quantity", "one number"},
    {"\"time\": 1, \"value\"", "\"figure\": \"max\", \"time\": @1, \"value\"", "/expected/0/time", "of the whole run"},
    {"\"time\": 1, \"value\"", "\"level\": @1, \"value\"", "/expected/0/level", "\"period\" alone"},
    {"{ \"quantity\": \"tip.x\", \"time\": 1, \"value\": 1, \"tolerance\": 5 }",
     "@{ \"quantity\": \"tip.x\", \"time\": 1, \"value\": 1 }", "/expected/0", "needs a tolerance"},
    {"\"value\": 1, \"tolerance\": 5", "\"value\": 0, \"relative_tolerance\": @0.1", "/expected/0/relative_tolerance",
     "which is 0"},
    {"{ \"name\": \"root\" },", "{ \"name\": \"root\" }, { \"name\": @\"spare\" },", "/nodes/1/name",
     "nothing holds it"},
};

// Frames that move, what is given in them, scenes that are described in them.
const Bad frame_cases[] = {
    {"\"motions\": [ ],",
     "\"motions\": [ { \"at\": \"tip\", \"x\": { \"signal\": @\"a\" } } ], \"signals\": [ { \"name\": \"a\", \"kind\": "
     "\"position\", \"at\": \"cart\", \"axis\": \"y\" } ],",
     "/motions/0/x/signal", "follows from where parts are at the same instant"},
    {"\"motions\": [ ],",
     "\"motions\": [ { \"at\": \"tip\", \"rotation\": { \"axis\": [0, 0, 1], \"angle\": { \"signal\": @\"a\" } } } ], "
     "\"signals\": [ { \"name\": \"a\", \"kind\": \"velocity\", \"at\": \"cart\", \"axis\": \"y\" } ],",
     "/motions/0/rotation/angle/signal", "drive by 2 states in a row"},
    {"\"motions\": [ ],",
     "\"motions\": [ { \"at\": \"tip\", \"rate\": true, \"z\": { \"signal\": @\"a\" } } ], \"signals\": [ { \"name\": "
     "\"a\", \"kind\": \"state\", \"expression\": \"1\" } ],",
     "/motions/0/z/signal", "not its rate"},
    {"\"motions\": [ ],",
     "\"motions\": [ { \"at\": \"tip\", \"z\": { \"kind\": \"sum\", \"terms\": [ 1, @{ \"signal\": \"a\" } ] } } ], "
     "\"signals\": [ { \"name\": \"a\", \"kind\": \"state\", \"expression\": \"1\" } ],",
     "/motions/0/z/terms/1", "a signal of kind \"formula\""},
    {"\"position\": [0, 0, 1], \"rotation\"", "\"position\": [0, @{ \"signal\": \"a\" }, 1], \"rotation\"",
     "/frames/0/position/1", "let the signal prescribe the motion of a node"},
    {"\"name\": \"bench\", ",
     "\"name\": \"bench\", \"turns\": [ { \"axis\": [0, 0, 1], \"angle\": @{ \"signal\": \"a\" } } ], ",
     "/frames/0/turns/0/angle", "parts are placed in a frame before any signal is known"},
    {"\"spectral_radius\": 0.9 },",
     "\"integrator\": \"variational\" }, \"signals\": [ @{ \"name\": \"a\", \"kind\": \"joint_reaction\", "
     "\"joint\": \"hinge\", \"component\": \"fx\" } ],",
     "/signals/0", "known to first order only"},
    {"\"mass\": 2, \"inertia\"", "\"density\": 2, \"inertia\"", "/bodies/0", "density and material go with a shape"},
    {"2, 2, 2] } ],", "2, 2, 2], \"stiffness_factor\": { \"signal\": @\"a\" } } ],",
     "/bushings/0/stiffness_factor/signal", "the scene has no signals"},
    {"2, 2, 2] } ],", "2, 2, 2], \"stiffness_factor\": @{ \"expression\": \"1/(t - 0.5)\" } } ],",
     "/bushings/0/stiffness_factor", "not finite at t = 0.5"},
    {"\"stiffness\": [1, 1, 1, 2, 2, 2] } ],", "\"damping\": [1, 1, 1, 2, 2, 2], \"stiffness_factor\": @2 } ],",
     "/bushings/0/stiffness_factor", "no stiffness that this factor could multiply"},
    {"2, 2, 2] } ],",
     "2, 2, 2], \"stiffness_factor\": { \"signal\": @\"a\" } } ], \"signals\": [ { \"name\": \"a\", \"kind\": "
     "\"joint_reaction\", \"joint\": \"hinge\", \"component\": \"fx\" } ],",
     "/bushings/0/stiffness_factor/signal", "let a state follow it"},
    {"\"stiffness\": 10 }", "\"stiffness\": @{ \"signal\": \"a\" } }", "/springs/0/stiffness",
     "this number is constant"},
    {"\"stiffness\": 10 }", "\"stiffness\": 10, \"stiffness_factor\": { \"signal\": @\"a\" } }",
     "/springs/0/stiffness_factor/signal", "the scene has no signals"},
    {"\"stiffness\": 10 }", "\"stiffness\": 10, \"rest_law\": { \"signal\": @\"a\" } }", "/springs/0/rest_law/signal",
     "no signal has this name"},
    {"{ \"name\": \"coil\",", "@{ \"name\": \"coil\", \"rest_length\": 1, \"rest_law\": 1,", "/springs/0",
     "takes only one of the keys"},
    {"\"motions\": [ ],",
     "\"motions\": [ ], \"actuators\": [ { \"name\": \"a\", \"kind\": \"servo\", \"joint\": @\"pinn\", \"limit\": 1, "
     "\"lag\": 1 } ],",
     "/actuators/0/joint", "no joint has this name"},
    {"\"motions\": [ ],",
     "\"motions\": [ ], \"actuators\": [ { \"name\": \"a\", \"kind\": \"servo\", \"joint\": \"hinge\", \"limit\": 1, "
     "\"lag\": 1, \"start\": @2 } ],",
     "/actuators/0/start", "beyond the limit of 1"},
    {"\"motions\": [ ],",
     "\"motions\": [ ], \"signals\": [ { \"name\": \"a\", \"kind\": \"joint_reaction\", \"joint\": \"hinge\", "
     "\"component\": @\"mz\" } ],",
     "/signals/0/component", "no row of a revolute joint alone"},
    {"\"stiffness\": 10 }", "\"force_law\": { \"expression\": @\"9*stretch + 2*rat\" } }",
     "/springs/0/force_law/expression", "it names length, stretch and rate of the spring"},
    {"\"stiffness\": 10 }", "\"force_law\": { \"expression\": @\"9*t\" } }", "/springs/0/force_law/expression",
     "at character 3"},
    {"\"gravity\": [0, 0, -9.81],", "\"gravity\": { \"components\": [0, 0, { \"signal\": @\"a\" }] },",
     "/gravity/components/2/signal", "no signal has this name"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"state\", \"expression\": \"1\", "
     "\"nominal\": @0 } ],",
     "/signals/0/nominal", "above 0"},
    {"\"kind\": \"dynamic\", \"end_time\": 1, \"step_size\": 1e-3, \"spectral_radius\": 0.9",
     "\"kind\": \"inverse_dynamics\", \"end_time\": 1, @\"start\": \"given\"", "/analysis/start",
     "this key is not known here"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"joint_effort\", \"joint\": @\"clamp\" } ],",
     "/signals/0/joint", "has no such coordinate"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"spring_tension\", \"spring\": @\"coli\" } ],",
     "/signals/0/spring", "did you mean \"coil\"?"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"surface\", \"of\": [\"b\", \"b\"], \"x\": [0, "
     "1], \"y\": [0, 1], \"values\": [ [1, 2], @[3] ] }, { \"name\": \"b\", \"kind\": \"time\", \"law\": 1 } ],",
     "/signals/0/values/1", "one value per y: 2"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"surface\", \"of\": [\"b\", \"b\"], \"x\": [0, "
     "1], \"y\": [0, 1], \"values\": @[ [1, 2] ] }, { \"name\": \"b\", \"kind\": \"time\", \"law\": 1 } ],",
     "/signals/0/values", "one row per x: 2"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ @{ \"name\": \"a\", \"kind\": \"surface\", \"of\": [\"b\", \"b\"], \"x\": "
     "[0, 0], \"y\": [0, 1], \"values\": [ [1, 2], [1, 2] ] }, { \"name\": \"b\", \"kind\": \"time\", \"law\": 1 } ],",
     "/signals/0", "must increase"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"surface\", \"of\": [\"b\", @\"c\"], \"x\": "
     "[0, 1], \"y\": [0], \"values\": [ [1], [3] ] }, { \"name\": \"b\", \"kind\": \"time\", \"law\": 1 } ],",
     "/signals/0/of/1", "did you mean"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"joint_effort\", \"joint\": \"hinge\" }, { "
     "\"name\": \"b\", \"kind\": \"joint_effort\", \"joint\": @\"hinge\" } ],",
     "/signals/1/joint", "is this effort already"},
    {"\"forces\": [ { \"damping\": 0.1 } ] }",
     "\"forces\": [ { \"damping\": 0.1, \"effort\": { \"signal\": @\"a\" } } ] }, { \"name\": \"rod\", \"kind\": "
     "\"distance\", \"first\": \"cart\", \"second\": \"tip\" } ], \"signals\": [ { \"name\": \"a\", \"kind\": "
     "\"joint_effort\", \"joint\": \"rod\" }",
     "/joints/2/forces/0/effort/signal", "which would follow from itself"},
    {"\"position\": [0, 0, 1], \"rotation\"", "\"position\": @[0, 0], \"rotation\"", "/frames/0/position", "3"},
    {"\"position\": [0, 0, 1], \"rotation\"", "\"position\": [0, { \"expression\": @\"sin(\" }, 1], \"rotation\"",
     "/frames/0/position/1/expression", "character"},
    {"\"position\": [0, 0, 1], \"rotation\"",
     "\"position\": [0, @{ \"expression\": \"1/(t - 0.5)\" }, 1], \"rotation\"", "/frames/0/position/1",
     "not finite at t = 0.5"},
    {"\"name\": \"bench\", ", "\"name\": \"bench\", \"turns\": [ { \"axis\": @[0, 0, 0], \"angle\": 1 } ], ",
     "/frames/0/turns/0/axis", "length other than 0"},
    {"\"name\": \"bench\", ",
     "\"name\": \"bench\", \"turns\": [ { \"axis\": [0, 0, 1], @\"rat\": true, \"angle\": 1 } ], ",
     "/frames/0/turns/0/rat", "did you mean \"rate\"?"},
    {"\"analysis\": { \"kind\": \"dynamic\",", "\"analysis\": { \"kind\": \"dynamic\", \"frame\": @\"bank\",",
     "/analysis/frame", "no frame has this name"},
    {"\"analysis\": { \"kind\": \"dynamic\",", "\"analysis\": { \"kind\": \"dynamic\", \"frame\": @\"cart\",",
     "/analysis/frame", "this is not a frame"},
    {"\"name\": \"coil\", \"first\": \"tip\", \"second\": \"cart\"",
     "\"name\": \"coil\", \"first\": \"ground\", \"second\": @\"bench\"", "/springs/0/second",
     "one of them has to be a node or body"},
    {"\"at\": \"tip\", \"force\"", "\"at\": @\"bench\", \"force\"", "/loads/0/at", "not a node or body"},
    {"\"at\": \"tip\", \"force\"", "\"frame\": @\"knee\", \"at\": \"tip\", \"force\"", "/loads/0/frame",
     "this is not a frame"},
    {"\"at\": \"tip\", \"force\"", "\"frame\": @\"bench\", \"axes\": \"body\", \"at\": \"tip\", \"force\"",
     "/loads/0/frame", "a follower turns with what it acts on"},
    {"\"of\": \"cart\"", "\"frame\": @\"bnch\", \"of\": \"cart\"", "/initial_velocities/0/frame",
     "did you mean \"bench\"?"},
    {"\"kind\": \"position\", \"at\": \"tip\"", "\"kind\": \"position\", \"at\": \"tip\", \"frame\": @\"bnch\"",
     "/sensors/0/frame", "did you mean \"bench\"?"},
    {"{ \"form\": \"local\" }", "{ \"form\": \"hybrid\", \"kind\": @\"global\" }", "/solver/kind",
     "is the former name of form, which is \"hybrid\""},
    {"{ \"form\": \"local\" }", "{ \"penalty_factor\": @10 }", "/solver/penalty_factor",
     "only the form \"augmented\" adds a penalty"},
    {"\"kind\": \"total_energy\"", "\"kind\": \"interface_force\", \"subdomain\": @\"0..1\"", "/sensors/3/subdomain",
     "no path in the tree"},
    {"\"position\": [0, 0, 1], \"rotation\"", "\"position\": @[0, 0], \"rotation\"", "/frames/0/position", "3"},
    {"\"position\": [0, 0, 1], \"rotation\"", "\"position\": [0, { \"expression\": @\"sin(\" }, 1], \"rotation\"",
     "/frames/0/position/1/expression", "character"},
    {"\"position\": [0, 0, 1], \"rotation\"",
     "\"position\": [0, @{ \"expression\": \"1/(t - 0.5)\" }, 1], \"rotation\"", "/frames/0/position/1",
     "not finite at t = 0.5"},
    {"\"name\": \"bench\", ", "\"name\": \"bench\", \"turns\": [ { \"axis\": @[0, 0, 0], \"angle\": 1 } ], ",
     "/frames/0/turns/0/axis", "length other than 0"},
    {"\"name\": \"bench\", ",
     "\"name\": \"bench\", \"turns\": [ { \"axis\": [0, 0, 1], @\"rat\": true, \"angle\": 1 } ], ",
     "/frames/0/turns/0/rat", "did you mean \"rate\"?"},
    {"\"analysis\": { \"kind\": \"dynamic\",", "\"analysis\": { \"kind\": \"dynamic\", \"frame\": @\"bank\",",
     "/analysis/frame", "no frame has this name"},
    {"\"analysis\": { \"kind\": \"dynamic\",", "\"analysis\": { \"kind\": \"dynamic\", \"frame\": @\"cart\",",
     "/analysis/frame", "this is not a frame"},
    {"\"name\": \"coil\", \"first\": \"tip\", \"second\": \"cart\"",
     "\"name\": \"coil\", \"first\": \"ground\", \"second\": @\"bench\"", "/springs/0/second",
     "one of them has to be a node or body"},
    {"\"at\": \"tip\", \"force\"", "\"at\": @\"bench\", \"force\"", "/loads/0/at", "not a node or body"},
    {"\"at\": \"tip\", \"force\"", "\"frame\": @\"knee\", \"at\": \"tip\", \"force\"", "/loads/0/frame",
     "this is not a frame"},
    {"\"at\": \"tip\", \"force\"", "\"frame\": @\"bench\", \"axes\": \"body\", \"at\": \"tip\", \"force\"",
     "/loads/0/frame", "a follower turns with what it acts on"},
    {"\"of\": \"cart\"", "\"frame\": @\"bnch\", \"of\": \"cart\"", "/initial_velocities/0/frame",
     "did you mean \"bench\"?"},
    {"\"kind\": \"position\", \"at\": \"tip\"", "\"kind\": \"position\", \"at\": \"tip\", \"frame\": @\"bnch\"",
     "/sensors/0/frame", "did you mean \"bench\"?"},
    {"\"kind\": \"total_energy\"", "\"kind\": \"total_energy\", @\"frame\": \"bench\"", "/sensors/3/frame", "frame"},
    {"\"kind\": \"joint_angle\", \"joint\"",
     "\"kind\": \"joint_reaction\", \"axes\": \"body\", \"frame\": @\"bench\", \"joint\"", "/sensors/2/frame",
     "not of both"},
    {"\"kind\": \"total_energy\"", "\"kind\": \"acceleration_split\", \"at\": \"tip\", \"frames\": @[ ]",
     "/sensors/3/frames", "1"},
    {"\"kind\": \"total_energy\"", "\"kind\": \"relative_position\", \"at\": \"tip\", \"frame\": @\"cat\"",
     "/sensors/3/frame", "did you mean \"cart\"?"},
    {"\"kind\": \"total_energy\"",
     "\"kind\": \"acceleration_split\", \"at\": \"tip\", \"frames\": [ \"bench\", @\"cat\" ]", "/sensors/3/frames/1",
     "did you mean \"cart\"?"},
    {"\"kind\": \"total_energy\"",
     "\"kind\": \"acceleration_split\", \"at\": \"tip\", \"frames\": [ \"bench\", @\"bench\" ]", "/sensors/3/frames/1",
     "in the chain already"},
    {"\"kind\": \"total_energy\"", "\"kind\": \"acceleration_split\", \"at\": \"tip\", \"frames\": [ @\"ground\" ]",
     "/sensors/3/frames/0", "starts in the inertial frame by itself"},
    {"\"kind\": \"total_energy\"",
     "\"kind\": \"acceleration_split\", \"beam\": \"upper\", \"station\": @2, \"frames\": [ \"bench\" ]",
     "/sensors/3/station", "1"},
    {"\"kind\": \"total_energy\"",
     "\"kind\": \"acceleration_split\", \"at\": \"tip\", \"frames\": [ \"bench\" ], \"frame\": @\"cat\"",
     "/sensors/3/frame", "did you mean \"cart\"?"},
    // Signals.
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": @\"sin\", \"kind\": \"time\", \"law\": 1 } ],", "/signals/0/name",
     "formulas cannot call a signal by this name"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"formula\", \"expression\": @\"2*angel\" } ],",
     "/signals/0/expression", "angel"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"formula\", \"expression\": @\"2*t\" } ],",
     "/signals/0/expression", "t stands in laws of time only"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ @{ \"name\": \"a\", \"kind\": \"formula\", \"expression\": \"b\" }, { "
     "\"name\": "
     "\"b\", \"kind\": \"function\", \"of\": \"a\", \"law\": 1 } ],",
     "/signals/0", "follow from each other in a circle"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"function\", \"of\": @\"ab\", \"law\": 1 } ],",
     "/signals/0/of", "did you mean \"a\"?"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"position\", \"at\": @\"rot\", \"axis\": \"x\" "
     "} ],",
     "/signals/0/at", "did you mean \"root\"?"},
    {"\"title\": \"base\",",
     "\"title\": \"base\", \"signals\": [ { \"name\": \"a\", \"kind\": \"joint_displacement\", \"joint\": @\"clamp\" } "
     "],",
     "/signals/0/joint", "has no such coordinate"},
    {"\"law\": { \"kind\": \"ramp\", \"end_time\": 0.5 }", "\"law\": { \"signal\": @\"thrust\" }",
     "/loads/0/law/signal", "the scene has no signals"},
    {"\"kind\": \"total_energy\"", "\"kind\": \"signal\", \"signal\": @\"thrust\"", "/sensors/3/signal",
     "no signal has this name"},
    {"\"axis\": [1, 0, 0] },", "\"axis\": [1, 0, 0], \"drives\": [ { \"law\": { \"signal\": @\"go\" } } ] },",
     "/joints/1/drives/0/law/signal", "the scene has no signals"},
    {"\"position\": [0, 0, 1], \"rotation\": { \"axis\"",
     "\"position\": [0, @{ \"signal\": \"y\" }, 1], \"rotation\": { "
     "\"axis\"",
     "/frames/0/position/1", "has to be a law of time here"},
    {"\"gravity\": [0, 0, -9.81]", "\"gravity\": { \"vector\": [0, 0, -9.81], \"law\": { \"signal\": @\"y\" } }",
     "/gravity/law/signal", "no signal has this name"},
};

struct Expectation {
  std::string text;
  int line = 0, column = 0;
};

Expectation marked(const Bad& bad) {
  Expectation e;
  e.text = test::spoilt(bad.from, bad.to);
  const std::size_t at = e.text.find('@');
  if (at == std::string::npos) return e;
  e.text.erase(at, 1);
  const LineColumn place = LineIndex(e.text).at(at);
  e.line = place.line;
  e.column = place.column;
  return e;
}

void check(const Bad& bad) {
  SCOPED_TRACE(std::string(bad.from) + "  ->  " + bad.to);
  const Expectation e = marked(bad);
  ASSERT_FALSE(e.text.empty()) << "the piece to replace is not in the base scene exactly once";
  const SceneFile file = read_scene_text(e.text, "bad");
  bool found = false;
  std::string all;
  for (const Problem& p : file.problems) {
    all += p.text() + "\n";
    const bool here = p.pointer == bad.pointer && p.text().find(bad.message) != std::string::npos;
    if (here && e.line > 0) {
      EXPECT_EQ(p.line, e.line) << p.text();
      EXPECT_EQ(p.column, e.column) << p.text();
    }
    found = found || here;
  }
  EXPECT_TRUE(found) << "expected " << bad.pointer << ": " << bad.message << "\ngot\n" << all;
  EXPECT_EQ(file.problems.size(), 1u) << "one fault, one problem; got\n" << all;
}

TEST(SceneBad, the_base_scene_itself_is_good) {
  const SceneFile file = read_scene_text(test::base_scene(), "base");
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  for (const Problem& p : file.warnings) ADD_FAILURE() << p.text();
}

TEST(SceneBad, each_broken_rule_is_reported_once_at_its_place) {
  for (const Bad& bad : table_cases) check(bad);
}

TEST(SceneBad, each_impossible_scene_is_reported_once_at_its_place) {
  const ::bough::test::Untrapped untrapped;  // the law 1/t
  for (const Bad& bad : scene_cases) check(bad);
}

TEST(SceneBad, each_fault_of_a_moving_frame_is_reported_once_at_its_place) {
  const ::bough::test::Untrapped untrapped;  // the law 1/(t - 0.5)
  for (const Bad& bad : frame_cases) check(bad);
}

TEST(SceneBad, frames_that_stand_in_each_other_in_a_circle_are_all_named) {
  const SceneFile file = read_scene_text(
      test::spoilt(
          "\"frames\": [ { \"name\": \"bench\", ",
          "\"frames\": [ { \"name\": \"desk\", \"frame\": \"bench\", \"turns\": [ { \"axis\": [0, 0, 1], \"angle\": "
          "{ \"expression\": \"t\" } } ] }, { \"frame\": \"desk\", \"name\": \"bench\", "),
      "circle", std::vector<std::string>{"/analysis/frame=desk"});
  ASSERT_EQ(file.problems.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(file.problems[i].pointer, "/frames/" + std::to_string(i) + "/frame");
    EXPECT_NE(file.problems[i].text().find("stands in itself"), std::string::npos);
  }
}

/// A static scene in a frame with one law replaced.
SceneFile turning_arm(const std::string& turns, const std::string& position, const std::string& gravity) {
  return read_scene_text(R"({"schema_version": 1, "gravity": )" + gravity + R"(,
    "frames": [{"name": "hub", "position": )" +
                             position + R"(, "turns": )" + turns + R"(}],
    "sections": [{"name": "s", "stiffness": [1, 1, 1, 1, 1, 1], "mass": [1, 1, 1, 1, 1, 1]}],
    "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
    "beams": [{"name": "arm", "section": "s", "start": "a", "end": "b", "elements": 1}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "a"}],
    "analysis": {"kind": "static", "frame": "hub"}})",
                         "arm");
}

TEST(SceneBad, statics_in_a_frame_that_does_not_move_steadily_is_refused) {
  const std::string steady = R"([{"axis": [0, 0, 1], "angle": 5, "rate": true}])";
  const std::string at_rest = "[0, 0, 0]", down = "[0, 0, -9.81]";
  EXPECT_TRUE(turning_arm(steady, at_rest, down).ok());
  EXPECT_TRUE(turning_arm("[]", R"([{"expression": "t + 2*t^2"}, 0, 0])", down).ok())
      << "a constant acceleration is steady";
  const auto expect_refused = [](const SceneFile& file, const std::string& what) {
    ASSERT_EQ(file.problems.size(), 1u) << what;
    EXPECT_EQ(file.problems[0].pointer, "/analysis/frame");
    EXPECT_NE(file.problems[0].text().find("its " + what), std::string::npos) << file.problems[0].text();
  };
  expect_refused(turning_arm(R"([{"axis": [0, 0, 1], "angle": {"expression": "t^2"}}])", at_rest, down),
                 "angular velocity");
  expect_refused(
      turning_arm(R"([{"axis": [0, 0, 1], "angle": 5, "rate": true}, {"axis": [1, 0, 0], "angle": 1, "rate": true}])",
                  at_rest, "[0, 0, 0]"),
      "angular velocity");
  expect_refused(turning_arm("[]", R"([{"expression": "t^3"}, 0, 0])", down), "acceleration");
  expect_refused(turning_arm(steady, at_rest, "[0, -9.81, 0]"), "gravity");
}

TEST(SceneBad, all_faults_of_a_file_are_reported_together_in_the_order_of_the_file) {
  std::string text = test::spoilt("\"young\": 2.1e11", "\"young\": -1");
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("\"start\": \"root\"", "\"start\": \"rot\"");
  replace("\"kind\": \"prismatic\"", "\"kind\": \"sliding\"");
  replace("\"of\": \"cart\"", "\"of\": \"card\"");
  replace("\"tip.x\"", "\"tip.q\"");
  const SceneFile file = read_scene_text(text, "many");
  ASSERT_EQ(file.problems.size(), 5u);
  EXPECT_EQ(file.problems[0].pointer, "/materials/0/young");
  EXPECT_EQ(file.problems[1].pointer, "/beams/0/start");
  EXPECT_EQ(file.problems[2].pointer, "/joints/1/kind");
  EXPECT_EQ(file.problems[3].pointer, "/initial_velocities/0/of");
  EXPECT_EQ(file.problems[4].pointer, "/expected/0/quantity");
}

TEST(SceneBad, a_misspelt_list_does_not_flood_the_report_with_missing_names) {
  const SceneFile file = read_scene_text(test::spoilt("\"nodes\"", "\"noods\""), "list");
  ASSERT_EQ(file.problems.size(), 1u);
  EXPECT_EQ(file.problems[0].pointer, "/noods");
}

TEST(SceneBad, a_flood_is_cut_and_counted) {
  std::string nodes;
  for (int i = 0; i < 1000; ++i) nodes += (i == 0 ? "" : ",") + std::string("{}");
  const SceneFile file = read_scene_text(
      "{\"schema_version\": 1, \"analysis\": {\"kind\": \"static\"}, \"nodes\": [" + nodes + "]}", "flood");
  ASSERT_EQ(file.problems.size(), max_problems);
  EXPECT_NE(file.problems.back().hint.find("more problems"), std::string::npos);
}

TEST(SceneBad, a_figure_of_a_time_beyond_the_end_is_warned_about) {
  const SceneFile file = read_scene_text(test::spoilt("\"time\": 1, \"value\"", "\"time\": 1.5, \"value\""), "late");
  EXPECT_TRUE(file.ok());
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_EQ(file.warnings[0].pointer, "/expected/0/time");
  EXPECT_NE(file.warnings[0].text().find("ends at 1, so this figure is not reached"), std::string::npos);
}

TEST(SceneBad, an_angle_that_looks_like_degrees_is_warned_about) {
  const SceneFile file = read_scene_text(test::spoilt("\"angle\": 0.5", "\"angle\": 45"), "degrees");
  EXPECT_TRUE(file.ok());
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_EQ(file.warnings[0].pointer, "/frames/0/rotation/angle");
  EXPECT_NE(file.warnings[0].text().find("radians"), std::string::npos);
}

/// An element of a joint has room for four: the fifth was written beyond it.
TEST(SceneBad, a_joint_with_more_forces_than_its_element_holds_is_refused) {
  const auto read = [](int count) {
    std::string forces = "{\"stiffness\": 1}";
    for (int k = 1; k < count; ++k) forces += ", {\"stiffness\": 1}";
    return read_scene_text(R"({"schema_version": 1, "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}],
        "joints": [{"name": "h", "kind": "revolute", "first": "ground", "second": "a", "position": [0, 0, 0],
                    "axis": [0, 0, 1], "forces": [)" +
                               forces + R"(]}], "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}})",
                           "forces");
  };
  EXPECT_TRUE(read(4).ok());
  const SceneFile five = read(5);
  ASSERT_FALSE(five.ok());
  EXPECT_NE(five.problems.front().text().find("/joints/0/forces"), std::string::npos);
}

/// Keys, names and words of a file, whatever they hold, are escaped where they are shown.
TEST(SceneBad, no_control_character_and_no_bad_byte_of_a_file_reaches_a_message) {
  const ::bough::test::Untrapped untrapped;  // 1e400
  for (const char* bad : {R"(\u0000)", R"(\u001b[2J)", R"(\u009b2J)", R"(\u007f)"}) {
    const std::string word = std::string("\"") + bad + "\"";
    for (const std::string& text : {"{" + word + ": 1}", R"({"nodes": [{"name": )" + word + "}]}",
                                    R"({"nodes": [{"name": "a", )" + word + ": 1}]}",
                                    "{" + word + ": {" + word + ": [1e400]}}", "{" + word + ": 1 " + word + "}"}) {
      const SceneFile file = read_scene_text(text, "bad");
      ASSERT_FALSE(file.ok()) << text;
      for (const Problem& p : file.problems)
        for (std::size_t i = 0; i < p.text().size(); ++i) {
          const auto c = static_cast<unsigned char>(p.text()[i]),
                     before = static_cast<unsigned char>(i > 0 ? p.text()[i - 1] : ' ');
          EXPECT_TRUE(c >= 0x20 && c != 0x7F && !(before == 0xC2 && c < 0xA0)) << text;
        }
    }
  }
  for (const char* bytes : {"\xED\xA0\x80", "\xC3", "\xE0\x80\x80", "\xF4\x90\x80\x80"})
    EXPECT_EQ(shown(bytes).find("\\x"), 0u) << bytes;
}

}  // namespace
}  // namespace bough::io
