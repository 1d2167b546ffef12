#pragma once
/// Breakpoints: times at which laws of a plan jump. They are searched while the run proceeds, because a law may have
/// any number of them and a run that ends early needs few.
#include <cstddef>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/records/archive.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

class BreakWalk {
 public:
  /// Keeps references.
  BreakWalk(const plan::Plan& plan, const scene::Analysis& analysis);

  /// Sets `end` to the first breakpoint after `begin`, or to the end of the analysis. Returns false if a law has too
  /// many breakpoints for a run; `fault` then names it. Breakpoints nearer to each other, or to the end, than 1e-9 of a
  /// step are merged.
  [[nodiscard]] bool next(double begin, double& end);
  const std::string& fault() const { return fault_; }
  void checkpoint(records::Archive& archive) { archive(found_, at_, searched_to_, stretch_, fault_); }

 private:
  bool search(double end);

  const scene::Analysis& analysis_;
  std::vector<const plan::LawPlan*> laws_;  ///< laws that are not constant
  std::vector<double> found_;               ///< breakpoints up to searched_to_, sorted
  std::size_t at_ = 0;                      ///< the first of found_ that is still ahead
  double searched_to_ = 0.0;
  double stretch_ = 1.0;  ///< length of a search in usual stretches; grows while nothing is found
  std::string fault_;
};

}  // namespace bough::run
