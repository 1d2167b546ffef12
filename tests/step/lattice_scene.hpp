#pragma once
/// A lattice of rigidly joined beams, large enough for the plan to take symmetric parts of its tangents.
#include <string>

#include "small_scenes.hpp"

namespace bough::test {

/// Ten by ten nodes "i,j" 0.5 m apart, in space, held by nothing.
inline scene::Scene make_lattice(scene::AnalysisKind kind) {
  constexpr int side = 10;
  constexpr double pitch = 0.5;
  scene::Scene s;
  s.name = "lattice";
  s.gravity = {{0.0, 0.0, -9.81}};
  s.sections.push_back(make_bar_section());
  s.analysis.kind = kind;
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 0.01;
  s.without = {"planar"};
  const auto name = [](int i, int j) { return std::to_string(i) + "," + std::to_string(j); };
  const auto add_beam = [&s](const std::string& start, const std::string& end) {
    scene::Beam b;
    b.name = start + " to " + end;
    b.section = "bar";
    b.start = start;
    b.end = end;
    s.beams.push_back(b);
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      scene::Node node;
      node.name = name(i, j);
      node.placement.pose.x = {{pitch * i, pitch * j, 0.0}};
      s.nodes.push_back(node);
      if (i > 0) add_beam(name(i - 1, j), name(i, j));
      if (j > 0) add_beam(name(i, j - 1), name(i, j));
    }
  return s;
}

}  // namespace bough::test
