#pragma once
/// Ways to break a rule of the table in the base scene. '@' marks where the problem has to be reported; it is taken out before reading.

namespace bough::io::test {

struct Bad {
  const char* from;
  const char* to;
  const char* pointer;
  const char* message;  ///< a piece of the problem's text
};

// Keys, types, ranges: what the table of rules sees. The published schema has to see these as well (scene_schema_test).
inline const Bad table_cases[] = {
    {"\"schema_version\": 1,", "\"schema_version\": @2,", "/schema_version", "at most 1"},
    {"\"schema_version\": 1,", "\"schema_version\": @\"1\",", "/schema_version", "without quotes"},
    {"\"schema_version\": 1,", "\"schema_version\": @1.5,", "/schema_version", "a whole number"},
    {"\"title\": \"base\"", "\"title\": @7", "/title", "a string, not a number"},
    {"\"title\": \"base\"", "@\"titel\": \"base\"", "/titel", "did you mean \"title\"?"},
    {"\"title\": \"base\"", "\"title\": @null", "/title", "null is not a value"},
    {"\"gravity\": [0, 0, -9.81]", "\"gravity\": @[0, -9.81]", "/gravity", "has 2 items and needs 3"},
    {"\"gravity\": [0, 0, -9.81]", "\"gravity\": @9.81", "/gravity", "not a number"},
    {"\"gravity\": [0, 0, -9.81]", "\"gravity\": [0, 0, @\"-9.81\"]", "/gravity/2", "without quotes"},
    {"\"gravity\": [0, 0, -9.81]", "\"gravity\": { @\"vectr\": [0, 0, -9.81] }", "/gravity/vectr", "did you mean \"vector\"?"},
    {"\"angle\": 0.5", "@\"angel\": 0.5", "/frames/0/rotation/angel", "did you mean \"angle\"?"},
    {"{ \"axis\": [0, 0, 1], \"angle\": 0.5 }", "@{ }", "/frames/0/rotation", "one of the keys \"axis\""},
    {"{ \"axis\": [0, 0, 1], \"angle\": 0.5 }", "{ \"quaternion\": @[1, 0, 0] }", "/frames/0/rotation/quaternion", "needs 4"},
    {"{ \"axis\": [0, 0, 1], \"angle\": 0.5 }", "{ @\"euler\": [1, 0, 0] }", "/frames/0/rotation/euler", "not known here"},
    {"\"young\": 2.1e11", "\"young\": @-2.1e11", "/materials/0/young", "above 0"},
    {"\"young\": 2.1e11", "\"young\": @0", "/materials/0/young", "above 0"},
    {"\"young\": 2.1e11, ", "@\"yuong\": 2.1e11, ", "/materials/0/yuong", "did you mean \"young\"?"},
    {"\"poisson\": 0.3", "\"poisson\": @0.6", "/materials/0/poisson", "of at most 0.5"},
    {"\"poisson\": 0.3", "@\"poison\": 0.3", "/materials/0/poison", "did you mean \"poisson\"?"},
    {"{ \"name\": \"steel\", \"young\": 2.1e11, \"poisson\": 0.3,", "@{ \"name\": \"steel\", \"young\": 2.1e11,", "/materials/0", "exactly one of the keys \"shear\" or \"poisson\""},
    {"{ \"name\": \"steel\", \"young\": 2.1e11,", "@{ \"name\": \"steel\", \"young\": 2.1e11, \"shear\": 1,", "/materials/0", "exactly one of the keys"},
    {"\"density\": 7850", "\"density\": @true", "/materials/0/density", "not a truth value"},
    {"\"kind\": \"rectangle\"", "\"kind\": @\"rectangel\"", "/sections/0/shape/kind", "did you mean \"rectangle\"?"},
    {"\"width\": 0.02, ", "", "/sections/0/shape", "needs the key \"width\""},
    {"\"width\": 0.02", "\"width\": @-0.02", "/sections/0/shape/width", "above 0"},
    {"\"EI3\": 30 }", "@\"EI_3\": 30 }", "/sections/1/stiffness/EI_3", "did you mean \"EI3\"?"},
    {"\"EI2\": 20", "\"EI2\": @[20]", "/sections/1/stiffness/EI2", "not an array"},
    {"\"mass_per_length\": 2", "\"mass_per_length\": @-2", "/sections/1/mass/mass_per_length", "at least 0"},
    {"\"name\": \"rubber\"", "\"name\": @\"\"", "/bushings/0/name", "at least one character"},
    {"\"name\": \"rubber\"", "\"name\": @\"ro.ot\"", "/bushings/0/name", "holds no '.'"},
    {"\"name\": \"rubber\"", "\"name\": @\"ro/ot\"", "/bushings/0/name", "holds no '.' and no '/'"},
    {"\"name\": \"rubber\"", "\"name\": @\"ro\\u0000ot\"", "/bushings/0/name", "no control characters"},
    {"\"name\": \"rubber\"", "\"name\": @\" root\"", "/bushings/0/name", "no space at its ends"},
    {"\"name\": \"rubber\"", "\"name\": @\"ground\"", "/bushings/0/name", "can not be a name"},
    {"{ \"name\": \"rubber\", ", "@{ ", "/bushings/0", "needs the key \"name\""},
    {"{ \"of\": \"cart\", \"velocity\": [1, 0, 0] }", "@\"cart\"", "/initial_velocities/0", "an object, not a string"},
    {"\"name\": \"knee\", \"position\"", "\"name\": \"knee\", @\"pos\"", "/nodes/1/pos", "known keys"},
    {"\"kind\": \"point_mass\"", "\"kind\": @\"pointmass\"", "/bodies/1/kind", "did you mean \"point_mass\"?"},
    {"\"mass\": 2, \"inertia\"", "\"mass\": @-2, \"inertia\"", "/bodies/0/mass", "at least 0"},
    {"\"elements\": 4", "\"elements\": @0", "/beams/0/elements", "at least 1"},
    {"\"elements\": 4", "\"elements\": @-1", "/beams/0/elements", "at least 1"},
    {"\"elements\": 4", "\"elements\": @1.9", "/beams/0/elements", "a whole number"},
    {"\"elements\": 4", "\"elements\": @1e30", "/beams/0/elements", "at most 1e+06"},
    {"\"elements\": 4", "\"elements\": @18446744073709551616", "/beams/0/elements", "at most 1e+06"},
    {"\"order\": 2", "\"order\": @4", "/beams/1/order", "at most 3"},
    {"\"section\": \"bar\"", "@\"sectoin\": \"bar\"", "/beams/0/sectoin", "did you mean \"section\"?"},
    {"\"kind\": \"prismatic\"", "\"kind\": @\"prismtic\"", "/joints/1/kind", "did you mean \"prismatic\"?"},
    {"\"kind\": \"prismatic\"", "\"kind\": @\"Prismatic\"", "/joints/1/kind", "did you mean \"prismatic\"?"},
    {"\"first\": \"ground\", \"second\": \"root\"", "\"first\": \"ground\", \"second\": @[\"root\"]", "/joints/0/second", "not an array"},
    {"\"damping\": 0.1", "\"damping\": @-0.1", "/joints/2/forces/0/damping", "at least 0"},
    {"\"stiffness\": 10 }", "\"stifness\": 10 }", "/springs/0/stifness", "did you mean \"stiffness\"?"},
    {"[1, 1, 1, 2, 2, 2]", "@[1, 1, 1, 2, 2]", "/bushings/0/stiffness", "needs 6"},
    {"\"kind\": \"ramp\"", "\"kind\": @\"rampe\"", "/loads/0/law/kind", "did you mean \"ramp\"?"},
    {"{ \"kind\": \"ramp\", \"end_time\": 0.5 }", "@{ \"kind\": \"ramp\" }", "/loads/0/law", "needs the key \"end_time\""},
    {"\"at\": \"tip\", \"force\"", "@\"att\": \"tip\", \"force\"", "/loads/0/att", "did you mean \"at\"?"},
    {"\"station\": 0 }", "\"station\": @1.5 }", "/sensors/1/station", "of at most 1"},
    {"\"kind\": \"joint_angle\"", "\"kind\": @\"joint_angel\"", "/sensors/2/kind", "did you mean \"joint_angle\"?"},
    {"\"kind\": \"position\", \"at\": \"tip\"", "\"kind\": \"position\"", "/sensors/0", "exactly one of the keys \"at\" or \"beam\""},
    {"\"kind\": \"dynamic\"", "\"kind\": @\"dynamics\"", "/analysis/kind", "did you mean \"dynamic\"?"},
    {"\"end_time\": 1,", "\"end_time\": @-1,", "/analysis/end_time", "above 0"},
    {"\"end_time\": 1, ", "", "/analysis", "needs the key \"end_time\""},
    {"\"step_size\": 1e-3", "\"step_size\": @0", "/analysis/step_size", "above 0"},
    {"\"spectral_radius\": 0.9", "\"spectral_radius\": @1.1", "/analysis/spectral_radius", "of at most 1"},
    {"{ \"kind\": \"automatic\" }", "{ \"kind\": @\"auto\" }", "/solver/kind", "has to be \"automatic\""},
    {"{ \"kind\": \"automatic\" }", "{ \"tasks\": @1 }", "/solver/tasks", "true or false, not a number"},
    {"\"stride\": 2", "\"stride\": @0", "/output/stride", "at least 1"},
    {"\"tolerance\": 5", "\"tolerance\": @0", "/expected/0/tolerance", "above 0"},
    {"\"title\": \"base\"", "\"comment\": @3", "/comment", "a comment has to be a string"},
};

}  // namespace bough::io::test
