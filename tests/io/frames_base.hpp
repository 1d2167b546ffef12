#pragma once
/// A good chain of frames that touches every key, for tests that spoil it in one place, and such spoilt pieces.
#include <string>

namespace bough::io::test {

inline const std::string& base_chain() {
  static const std::string text = R"({
  "schema_version": 1,
  "title": "rotor",
  "frames": [
    { "name": "car", "position": [ { "expression": "10*t" }, 0, 0.5 ], "turns": [ { "axis": [0, 0, 2], "angle": { "kind": "smooth_ramp", "end_time": 2, "to": 1.5 } } ] },
    { "name": "gimbal", "rotation": { "axis": [0, 1, 0], "angle": 0.4 }, "turns": [ { "axis": [1, 0, 0], "angle": { "kind": "harmonic", "amplitude": 0.2, "omega": 6 } } ] },
    { "name": "rotor", "turns": [ { "axis": [0, 0, 1], "angle": 20, "rate": true } ] }
  ],
  "point": { "position": [0.2, 0, { "expression": "0.1*t^2" }], "frame": "rotor" },
  "from": "car",
  "in": "gimbal",
  "time": { "start": 0, "end": 2, "points": 5 }
}
)";
  return text;
}

/// A piece of the base chain replaced; '@' marks where the problem has to be reported and is taken out before reading.
struct BadChain {
  const char *from, *to, *pointer, *rule;
};

/// What the table of rules sees, and so a JSON Schema too.
inline const BadChain chain_table_cases[] = {
    {"\"schema_version\": 1,", "\"schema_version\": @2,", "/schema_version", "at least 1 and of at most 1"},
    {"\"title\": \"rotor\",", "\"titel\": \"rotor\",", "/titel", "did you mean \"title\"?"},
    {"\"position\": [ { \"expression\": \"10*t\" }, 0, 0.5 ]", "\"position\": @[0, 0]", "/frames/0/position",
     "2 items and needs 3"},
    {"{ \"axis\": [0, 0, 2], \"angle\"", "{ \"axes\": [0, 0, 2], \"angle\"", "/frames/0/turns/0/axes",
     "did you mean \"axis\"?"},
    {"\"kind\": \"harmonic\"", "\"kind\": @\"harmonik\"", "/frames/1/turns/0/angle/kind", "did you mean \"harmonic\"?"},
    {"\"rate\": true", "\"rate\": @1", "/frames/2/turns/0/rate", "true or false"},
    {"\"end\": 2,", "\"ende\": 2,", "/time/ende", "did you mean \"end\"?"},
    {"\"points\": 5", "\"points\": @1", "/time/points", "at least 2"},
    {"\"points\": 5", "\"points\": @2.5", "/time/points", "whole number"},
    {"\"name\": \"gimbal\", ", "", "/frames/1", "needs the key \"name\""},
    {"\"name\": \"gimbal\"", "\"name\": @\"ground\"", "/frames/1/name", "inertial frame"},
};

inline std::string spoilt_chain(const BadChain& bad) {
  std::string text = base_chain();
  const std::string from = bad.from;
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) return {};
  return text.replace(at, from.size(), bad.to);
}

}  // namespace bough::io::test
