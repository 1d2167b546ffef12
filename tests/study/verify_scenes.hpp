#pragma once
/// Scenes in a few lines and runs kept in memory, for the verification of statics, solvers and messages.
#include <string>
#include <string_view>
#include <vector>

#include "bough/results/records.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/advance.hpp"

namespace bough::verify {

using motion::Vec3;

/// A run as its recorder saw it.
struct Outcome {
  results::HistoryHeader header;
  std::vector<results::HistoryRow> rows;
  results::Summary summary;

  bool ok() const { return summary.status == results::RunStatus::ok; }
  std::size_t column(std::string_view name) const;
  double final(std::string_view name) const { return summary.final_values.at(column(name)); }
  std::vector<double> series(std::string_view name) const;
  /// Whether some note or the cause holds the text.
  bool says(std::string_view text) const;
  /// Cause and notes, for messages of tests.
  std::string text() const;
};

/// What problems_in has against a scene, warnings left out; empty when nothing.
std::string problems_of(const scene::Scene& scene);

/// Runs a scene that has to be without problems; otherwise the outcome is failed and the cause starts with "refused: ".
Outcome run(const scene::Scene& scene, int threads = 1);

/// A scene of the gallery with overrides as on the command line.
scene::Scene gallery(const std::string& name, const std::vector<std::string>& overrides = {});
std::vector<std::string> gallery_names();

/// Diagonal section; mass per length and rotary inertia about the three axes when given.
scene::Section make_section(const std::string& name, double EA, double GA2, double GA3, double GJ, double EI2,
                            double EI3);
void set_mass(scene::Section& section, double mass, double rotary_1, double rotary_2, double rotary_3);

scene::Node make_node(const std::string& name, const Vec3<double>& position);
scene::Beam make_beam(const std::string& name, const std::string& section, const std::string& start,
                      const std::string& end, int elements, int order);
scene::Joint make_weld(const std::string& name, const std::string& node);
scene::PointLoad make_load(const std::string& node, const Vec3<double>& force,
                           const Vec3<double>& moment = Vec3<double>::zero(),
                           scene::LoadAxes axes = scene::LoadAxes::space);
scene::Sensor make_point_sensor(const std::string& name, scene::SensorKind kind, const std::string& node);
scene::Sensor make_section_sensor(const std::string& name, const std::string& beam, double station);
scene::Sensor make_joint_sensor(const std::string& name, const std::string& joint,
                                scene::SensorKind kind = scene::SensorKind::joint_reaction);

/// Straight static cantilever from the origin along x, axis 2 along y: nodes "root" and "tip", beam "beam", joint "clamp", sensors "tip" (position),
/// "turn" (rotation), "clamp" (reaction).
scene::Scene make_cantilever(const scene::Section& section, double length, int elements, int order);

/// A plan with its system and state, to call single verbs.
struct Direct {
  explicit Direct(const scene::Scene& scene);
  plan::Plan plan;
  step::System system;
  step::State state;
  step::StepOptions options;
  Vec3<double> position(const std::string& node) const;
};

/// log2 of the ratio of two errors of meshes that differ by a factor of two.
double observed_order(double coarse, double fine);

}  // namespace bough::verify
