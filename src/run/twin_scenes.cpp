#include "twin_scenes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_map>

#include "bough/io/number_text.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/memory_run.hpp"
#include "bough/scene/analysis_kinds.hpp"

namespace bough::run {

namespace {

/// Calls f with every name of the scene that may be that of an inner node of a beam.
template <class Scene, class F>
void for_each_place(Scene& scene, F&& f) {
  for (auto& j : scene.joints) {
    f(j.first.to);
    f(j.second.to);
  }
  for (auto& c : scene.couplings) {
    f(c.first.to);
    f(c.second.to);
  }
  for (auto& l : scene.point_loads) f(l.at.to);
  for (auto& m : scene.motions) f(m.at.to);
  for (auto& v : scene.initial_velocities) f(v.of);
  for (auto& b : scene.beams) {
    f(b.start);
    f(b.end);
  }
  for (auto& s : scene.signals) {
    f(s.at.to);
    f(s.frame);
  }
  for (auto& s : scene.sensors) {
    f(s.at.to);
    f(s.frame);
    for (auto& name : s.chain) f(name);
  }
}

/// The number k of an inner node "<beam>.<k>"; -1: the name is that of something else.
int inner_node(const std::string& name) {
  const std::size_t dot = name.rfind('.');  // names of parts have no dot
  if (dot == std::string::npos) return -1;
  int k = -1;
  const char* const end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + dot + 1, end, k);
  return read.ec == std::errc() && read.ptr == end ? k : -1;
}

/// How often all numbers of elements, and all numbers of inner nodes that the scene names, can be halved.
int halvings_of(const scene::Scene& scene) {
  int halvings = 2;
  const auto see = [&halvings](int number) {
    while (halvings > 0 && number % (1 << halvings) != 0) --halvings;
  };
  for (const scene::Beam& b : scene.beams) see(b.elements);
  for_each_place(scene, [&see](const std::string& name) {
    if (const int k = inner_node(name); k >= 0) see(k);
  });
  return halvings;
}

/// Values are recorded at the times at which twins are compared: in dynamics samples at given times, else all rows.
scene::Scene plain(scene::Scene scene) {
  constexpr int no_rows = 1 << 30;
  scene.output = {};
  scene.output.checks = false;
  scene.output.checkpoint = 0.0;
  if (scene::type_of(scene.analysis.kind).integrates) scene.output.stride = no_rows;
  scene.analysis.errors = {};
  return scene;
}

void add_in_time(const scene::Scene& scene, Twins& twins) {
  const scene::AnalysisType& kind = scene::type_of(scene.analysis.kind);
  if (kind.integrates) {
    for (const double factor : {2.0, 4.0})
      if (factor * scene.analysis.step_size <= scene.analysis.end_time)
        twins.members.push_back(twin_in_time(scene, factor));
    if (twins.members.empty())
      twins.remarks.push_back("no error in time is measured: the run has one step, and none can be longer");
  } else if (kind.is_in_time) {
    twins.remarks.emplace_back("there is no error in time: nothing is integrated");
  } else if (scene.analysis.arc_length) {
    twins.remarks.emplace_back("no error of the steps is measured: those along a path by arc length are free");
  } else {
    Twin twin{plain(scene), false, 2.0};
    twin.scene.analysis.load_steps *= 2;
    twins.members.push_back(std::move(twin));
  }
}

void add_of_mesh(const scene::Scene& scene, Twins& twins) {
  if (scene.beams.empty()) {
    twins.remarks.emplace_back("there is no error of the mesh: the scene has no beams");
    return;
  }
  constexpr double factors[3][2] = {{2.0, 4.0}, {0.5, 2.0}, {0.5, 0.25}};
  for (const double factor : factors[halvings_of(scene)]) {
    Twin twin{plain(with_elements(scene, factor)), true, factor};
    if (const std::string refused = refusal_of(twin.scene); !refused.empty())
      twins.remarks.push_back("no twin with other numbers of elements can run:" + refused);
    else
      twins.members.push_back(std::move(twin));
  }
}

}  // namespace

scene::Scene with_elements(const scene::Scene& scene, double factor, const std::string& beam) {
  const auto times = [factor](int number) { return static_cast<int>(std::lround(number * factor)); };
  scene::Scene other = scene;
  for (scene::Beam& b : other.beams)
    if (beam.empty() || b.name == beam) b.elements = times(b.elements);
  for_each_place(other, [&](std::string& name) {
    const int k = inner_node(name);
    if (k < 0 || (!beam.empty() && name.substr(0, name.rfind('.')) != beam)) return;
    name = name.substr(0, name.rfind('.') + 1) + std::to_string(times(k));
  });
  return other;
}

scene::ErrorsWanted errors_of(const scene::Scene& scene) {
  const scene::AnalysisType& kind = scene::type_of(scene.analysis.kind);
  return {scene.analysis.errors.time && (kind.integrates || !kind.is_in_time),
          scene.analysis.errors.mesh && !scene.beams.empty()};
}

std::string text_of(const Twin& twin) {
  if (twin.is_of_mesh) return io::rounded_text(twin.factor, 3) + " times as many elements";
  return twin.scene.analysis.kind == scene::AnalysisKind::statics
             ? io::rounded_text(twin.factor, 3) + " times as many load steps"
             : "steps " + io::rounded_text(twin.factor, 3) + " times as long";
}

Twin twin_in_time(const scene::Scene& scene, double factor) {
  Twin twin{plain(scene), false, factor, 1.0 / factor};
  twin.scene.analysis.step_size *= factor;
  return twin;
}

std::vector<Twin> twins_of_beams(const scene::Scene& scene) {
  std::vector<Twin> twins;
  for (const scene::Beam& b : scene.beams) twins.push_back({plain(with_elements(scene, 2.0, b.name)), true, 2.0, 1.0});
  return twins;
}

Twins make_twins(const scene::Scene& scene) {
  Twins twins;
  if (scene.analysis.errors.time) add_in_time(scene, twins);
  if (scene.analysis.errors.mesh) add_of_mesh(scene, twins);
  const double own = estimate_run(scene).seconds();
  for (Twin& t : twins.members) t.cost = own > 0.0 ? estimate_run(t.scene).seconds() / own : 1.0;
  return twins;
}

}  // namespace bough::run
