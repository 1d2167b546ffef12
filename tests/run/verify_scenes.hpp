#pragma once
/// Scenes in a few lines and runs kept in memory, for the verification of statics, solvers and messages.
#include <string>
#include <string_view>
#include <vector>

#include "bough/run/memory_run.hpp"
#include "bough/scene/parts.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/advance.hpp"

namespace bough::verify {

using motion::Vec3;

using Outcome = run::MemoryRun;

/// What problems_in has against a scene, warnings left out; empty when nothing.
inline std::string problems_of(const scene::Scene& scene) { return run::refusal_of(scene); }

/// Runs a scene that has to be without problems; otherwise the outcome is failed and the cause starts with "refused: ".
Outcome run(const scene::Scene& scene, int threads = 1);

/// A scene of the gallery with overrides as on the command line.
scene::Scene gallery(const std::string& name, const std::vector<std::string>& overrides = {});
std::vector<std::string> gallery_names();

using scene::make_beam;
using scene::make_cantilever;
using scene::make_joint_sensor;
using scene::make_load;
using scene::make_node;
using scene::make_point_sensor;
using scene::make_section;
using scene::make_section_sensor;
using scene::make_weld;
using scene::set_mass;

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
