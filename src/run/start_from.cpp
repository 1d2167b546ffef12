#include <algorithm>
#include <map>

#include "bough/io/number_text.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/analysis_kinds.hpp"

namespace bough::run {

namespace {

std::string in_words(const std::string& frame) {
  return frame.empty() ? "the inertial frame" : "frame '" + frame + "'";
}

std::string mesh_of(int elements, int order) {
  return std::to_string(elements) + (elements == 1 ? " element" : " elements") + " of order " + std::to_string(order);
}

}  // namespace

double start_time(const records::StoredState& from) { return from.runs_over_load ? 0.0 : from.time; }

std::vector<std::string> problems_of_start(const scene::Scene& scene, const records::StoredState& from) {
  std::vector<std::string> problems;
  const scene::Analysis& analysis = scene.analysis;
  if (!scene::type_of(analysis.kind).integrates) {
    problems.emplace_back("/analysis/kind: dynamics starts from a state of another run, and no other analysis does");
    return problems;
  }
  if (analysis.start == scene::StartKind::equilibrium)
    problems.emplace_back(
        "/analysis/start: the run cannot start from a state and in the equilibrium of the scene; leave out one of the "
        "two");
  if (const double begin = start_time(from); !(analysis.end_time > begin * (1.0 + 1e-9)))
    problems.push_back("/analysis/end_time: the scene ends at " + io::rounded_text(analysis.end_time, 6) +
                       " s, and the state is one of " + io::rounded_text(begin, 6) +
                       " s, from which time goes on; set a later end");
  if (from.frame != analysis.frame)
    problems.push_back("/analysis/frame: the scene is described in " + in_words(analysis.frame) +
                       ", and the state in " + in_words(from.frame) + "; describe both in one");
  std::map<std::string_view, const records::StoredBeam*> beams;
  for (const records::StoredBeam& beam : from.beams) beams.emplace(beam.name, &beam);
  for (std::size_t i = 0; i < scene.beams.size(); ++i) {
    const scene::Beam& beam = scene.beams[i];
    const auto found = beams.find(beam.name);
    if (found == beams.end()) continue;
    const records::StoredBeam& was = *found->second;
    if (was.elements == beam.elements && was.order == beam.order) continue;
    problems.push_back("/beams/" + std::to_string(i) + ": beam '" + beam.name + "' has " +
                       mesh_of(beam.elements, beam.order) + ", and the state has it with " +
                       mesh_of(was.elements, was.order) + ", so that its nodes are others; give it the same here");
  }
  const auto known = [&](const std::string& name) {
    return std::any_of(from.parts.begin(), from.parts.end(), [&](const auto& part) { return part.name == name; });
  };
  const bool has_any =
      std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const auto& b) { return known(b.name); }) ||
      std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const auto& n) { return known(n.name); }) ||
      std::any_of(scene.beams.begin(), scene.beams.end(), [&](const auto& b) { return beams.count(b.name) > 0; });
  if (!has_any) problems.emplace_back("no node, body or beam of the scene has the name of one of the state");
  return problems;
}

}  // namespace bough::run
