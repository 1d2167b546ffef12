#pragma once
/// Hand-made records and a directory of one's own for tests of what a run writes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "bough/records/run.hpp"
#include "support/scratch_directory.hpp"

namespace bough::io {

using support::ScratchDirectory;

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A bent beam of `num_points`, one body and one link, at time t.
inline records::MotionFrame sample_frame(double t, std::size_t num_points = 5) {
  records::MotionFrame frame;
  frame.time = t;
  records::Curve& curve = frame.curves.emplace_back();
  curve.name = "beam";
  for (std::size_t k = 0; k < num_points; ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(num_points - 1), angle = 0.3 * s * std::sin(t);
    records::CurvePoint point{
        {s, 0.1 * s * s * std::sin(t), 0.0},
        {std::cos(angle), -std::sin(angle), 0.0, std::sin(angle), std::cos(angle), 0.0, 0.0, 0.0, 1.0},
        {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}};
    curve.points.push_back(point);
  }
  frame.bodies.push_back({"crank", {0.0, 0.0, 0.0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.1, 0.0, 0.0}, {{0.2, 0.0, 0.3}}});
  frame.links.push_back({"hinge", {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
  return frame;
}

inline records::Summary sample_summary() {
  records::Summary summary;
  summary.status = records::RunStatus::ok;
  summary.scene = "sample";
  summary.header.columns = {"tip.x", "tip.y", "energy"};
  summary.final_values = {1.0, -0.1, 3.5};
  summary.options = {
      {"analysis/kind", "\"dynamic\""}, {"analysis/step_size", "0.001"}, {"analysis/newton", "\"full\""}};
  summary.expected = {{"tip.x", 1.0, 1.0, 1e-9, true, "by hand"}, {"tip.y", -0.1, -0.2, 1e-9, false, ""}};
  summary.steps = {10, 1, 33, 30};
  return summary;
}

}  // namespace bough::io
