#pragma once
/// Times at which laws of a plan jump, looked for as a run comes to them: a law may have any number of them, a run
/// that ends early needs few.
#include <cstddef>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

class BreakWalk {
 public:
  /// Keeps references.
  BreakWalk(const plan::Plan& plan, const scene::Analysis& analysis);

  /// The first time after `begin` at which a law jumps, or the end of the analysis. False where a law jumps so often
  /// that no run gets there; `fault` then names it. Breakpoints nearer to each other, or to the end, than 1e-9 of a
  /// step are one.
  [[nodiscard]] bool next(double begin, double& end);
  const std::string& fault() const { return fault_; }

 private:
  bool search(double end);

  const scene::Analysis& analysis_;
  std::vector<const plan::LawPlan*> laws_;  ///< that may jump
  std::vector<double> found_;               ///< up to searched_to_, sorted
  std::size_t at_ = 0;                      ///< the first of found_ that is not passed
  double searched_to_ = 0.0;
  double stretch_ = 1.0;  ///< in the usual ones: grows where nothing is found
  std::string fault_;
};

}  // namespace bough::run
