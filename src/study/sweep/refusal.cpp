/// Checks from the scenes alone whether the runs of a study fit in memory.
#include <algorithm>

#include "bough/run/estimate.hpp"
#include "bough/study/sweep.hpp"
#include "references.hpp"
#include "sampled_run.hpp"

namespace bough::study {
namespace {

/// A planned run and the memory that it needs.
struct Variant {
  std::string name;
  std::vector<std::string> overrides;
  double memory_bytes = 0.0;
};

std::string name_of(const io::StudyGrid& grid, const std::vector<std::size_t>& choices) {
  std::string name;
  for (std::size_t a = 0; a < grid.axes.size(); ++a)
    name += (a == 0 ? "" : ", ") + grid.axes[a].name + " " + grid.axes[a].choices[choices[a]].label;
  return "the run '" + name + "' of the grid '" + grid.name + "'";
}

std::vector<Variant> references_of(const io::StudySpec& spec, const ReferenceCache& cache) {
  std::vector<Variant> variants;
  for (const ReferenceRun& run : plan_references(spec).runs)
    if (!cache.find(run.from)) variants.push_back({"a computed reference", run.overrides});
  return variants;
}

std::vector<Variant> runs_of(const io::StudySpec& spec) {
  std::vector<Variant> variants;
  for (const io::StudyGrid& grid : spec.grids)
    for (const std::vector<std::size_t>& choices : io::combinations_of(grid))
      variants.push_back({name_of(grid, choices), io::overrides_of(spec, grid, choices)});
  return variants;
}

/// The largest run that does not fit, and how many there are. References and runs are not executed at the same time.
std::string refusal_of(const io::StudySpec& spec, std::vector<Variant> variants, const SweepOptions& options) {
  if (variants.empty()) return "";
  const auto side_by_side = std::min(variants.size(), static_cast<std::size_t>(std::max(1, options.threads)));
  const double limit = options.memory_limit / static_cast<double>(side_by_side);
  std::string text;
  std::size_t refused = 0;
  double largest = 0.0;
  const Variant* worst = nullptr;
  for (Variant& v : variants) {
    const scene::Scene scene = study_scene(spec, v.overrides);
    const std::string why = run::refusal(scene, limit);
    if (why.empty()) continue;
    ++refused;
    v.memory_bytes = run::estimate_run(scene).memory_bytes;
    if (v.memory_bytes <= largest) continue;
    largest = v.memory_bytes;
    worst = &v;
    text = why;
  }
  if (worst == nullptr) return "";
  const std::string others = refused == 1 ? "" : " (and " + std::to_string(refused - 1) + " more)";
  const std::string shared = side_by_side == 1 ? ""
                                               : "; " + std::to_string(side_by_side) +
                                                     " runs go side by side and share what is there: "
                                                     "fewer --threads leave more to each";
  return worst->name + others + ": " + text + shared;
}

}  // namespace

std::string refusal(const io::StudySpec& spec, const SweepOptions& options) {
  if (options.memory_limit == std::numeric_limits<double>::infinity()) return "";
  const std::string why = refusal_of(spec, references_of(spec, ReferenceCache(options.cache)), options);
  return why.empty() ? refusal_of(spec, runs_of(spec), options) : why;
}

}  // namespace bough::study
