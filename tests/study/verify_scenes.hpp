#pragma once
/// Scenes in a few lines and runs kept in memory, for the verification of statics, solvers and messages.
#include <string>
#include <string_view>
#include <vector>

#include "bough/scene/scene.hpp"
#include "bough/step/advance.hpp"
#include "bough/study/memory_run.hpp"
#include "bough/study/scene_parts.hpp"

namespace bough::verify {

using motion::Vec3;

using Outcome = study::MemoryRun;

/// What problems_in has against a scene, warnings left out; empty when nothing.
inline std::string problems_of(const scene::Scene& scene) { return study::refusal_of(scene); }

/// Runs a scene that has to be without problems; otherwise the outcome is failed and the cause starts with "refused: ".
Outcome run(const scene::Scene& scene, int threads = 1);

/// A scene of the gallery with overrides as on the command line.
scene::Scene gallery(const std::string& name, const std::vector<std::string>& overrides = {});
std::vector<std::string> gallery_names();

using study::make_beam;
using study::make_cantilever;
using study::make_joint_sensor;
using study::make_load;
using study::make_node;
using study::make_point_sensor;
using study::make_section;
using study::make_section_sensor;
using study::make_weld;
using study::set_mass;

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
