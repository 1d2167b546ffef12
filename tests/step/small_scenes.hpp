#pragma once
/// Scenes of a few elements, made without files.
#include <string>

#include "bough/laws/make_law.hpp"
#include "bough/scene/scene.hpp"

namespace bough::test {

inline scene::Section make_bar_section() {
  scene::Section s;
  s.name = "bar";
  s.stiffness = s.mass = s.damping = motion::Mat6<double>::zero();
  const double stiffness[6] = {8.4e7, 2.7e7, 2.7e7, 1.8e3, 2.8e3, 2.8e3},
               mass[6] = {3.14, 3.14, 3.14, 2.1e-4, 1.05e-4, 1.05e-4};
  for (int i = 0; i < 6; ++i) {
    s.stiffness(i, i) = stiffness[i];
    s.mass(i, i) = mass[i];
  }
  return s;
}

/// A frame "table" that swings about an axis through the origin.
inline scene::FrameDef make_turntable(const motion::Vec3<double>& axis) {
  scene::FrameDef frame;
  frame.name = "table";
  frame.motion = scene::MovingFrame{};
  frame.motion->turns.push_back({axis, laws::make_harmonic(0.3, 2.0, 0.0, 0.0)});
  return frame;
}

/// Links of two beam elements hanging by revolute joints about y, from the horizontal.
inline scene::Scene make_chain(int links, int order = 1) {
  scene::Scene s;
  s.name = "chain";
  s.gravity = {{0.0, 0.0, -9.81}};
  s.sections.push_back(make_bar_section());
  const motion::Mat3<double> axes{{1, 0, 0, 0, 0, 1, 0, -1, 0}};  // axis 3 along y
  for (int l = 0; l < links; ++l) {
    const std::string n = std::to_string(l);
    for (int end = 0; end < 2; ++end) {
      scene::Node node;
      node.name = (end == 0 ? "a" : "b") + n;
      node.placement.pose.x = {{static_cast<double>(l + end), 0.0, 0.0}};
      s.nodes.push_back(node);
    }
    scene::Beam b;
    b.name = "link" + n;
    b.section = "bar";
    b.start = "a" + n;
    b.end = "b" + n;
    b.elements = 2;
    b.order = order;
    s.beams.push_back(b);
    scene::Joint j;
    j.name = "hinge" + n;
    j.kind = scene::JointKind::revolute;
    j.first.to = l == 0 ? "" : "b" + std::to_string(l - 1);
    j.second.to = "a" + n;
    j.first.offset.R = j.second.offset.R = axes;
    s.joints.push_back(j);
  }
  s.analysis.end_time = 0.1;
  return s;
}

}  // namespace bough::test
