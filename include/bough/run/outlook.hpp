#pragma once
/// What a run of a scene will take, and what each decision of the plan saves, before it runs.
#include <cstdint>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// What one step costs, by a model with costs of one machine (step/step_cost.hpp): for comparisons of a scene with
/// itself; on another machine, or busy ones, all seconds are off by one factor.
struct Effort {
  std::int64_t unknowns = 0;
  double factor_flops = 0.0;      ///< of one factorization [flop]
  double factorizations = 0.0;    ///< a step, and
  double iterations = 0.0;        ///< assumed of Newton: as usual at the default tolerance
  double evaluate_seconds = 0.0;  ///< elements, residuals and tangents, a step on one thread [s]
  double factor_seconds = 0.0;    ///< the same
  double solve_seconds = 0.0;     ///< the same, with the check of the solution
  double other_seconds = 0.0;     ///< nodes moved, sums
  std::int64_t memory_bytes = 0;  ///< of solver, elements and states
  double step_seconds() const { return evaluate_seconds + factor_seconds + solve_seconds + other_seconds; }
};

struct OutlookDecision {
  plan::Decision decision;
  bool has_saving = false;  ///< taken and can be barred
  Effort without;           ///< the step if it were barred
};

struct Outlook {
  std::string scene, title;
  std::size_t nodes = 0, elements = 0, joints = 0;
  std::int64_t unknowns_in_space = 0;  ///< six a node and every row of every joint
  std::string motions;                 ///< "in space", "in a plane", ...
  std::string cut;                     ///< how the tree was made
  int sub_domains = 0, leaves = 0, levels = 0, fronts_in_lanes = 0, fronts_in_registers = 0, fronts = 0;
  Effort effort;
  double steps = 0.0;  ///< of equal size, or load steps; where errors choose steps, as many as of the first size
  std::int64_t process_bytes = 0;  ///< peak of the process that runs it, about: the program, and memory_bytes
  plan::Mobility mobility;
  std::vector<OutlookDecision> decisions;
  std::vector<std::string> notes;
};

/// Builds plan, tree and solver of a scene, once as it is and once without each decision. Precondition:
/// problems_in(scene) is empty.
Outlook look_ahead(const scene::Scene& scene);

}  // namespace bough::run
