#pragma once
/// Predicted cost of a run, and the saving by each decision of the plan, before the run.
#include <cstdint>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// Cost of one step, without sensors, pictures and files. The whole step is as long as trial steps took on this
/// machine; a model (step/step_cost.hpp) divides it into parts. Without trial steps the seconds are those of the model,
/// which has the costs of one machine: on another or a busy machine all of them are wrong by a common factor.
struct Effort {
  std::int64_t unknowns = 0;
  double factor_flops = 0.0;      ///< of one factorization [flop]
  double factorizations = 0.0;    ///< per step
  double iterations = 0.0;        ///< Newton corrections per step
  double evaluations = 0.0;       ///< of all elements, per step
  int trial_steps = 0;            ///< from which these numbers and the step's time come; 0: numbers are usual ones
  double evaluate_seconds = 0.0;  ///< elements, residuals and tangents, per step on one thread [s]
  double factor_seconds = 0.0;    ///< the same
  double solve_seconds = 0.0;     ///< the same, with the check of the solution's residual
  double other_seconds = 0.0;     ///< updates of nodes, predictors, balances
  double model_seconds = 0.0;     ///< the whole step by the model alone [s]
  std::int64_t memory_bytes = 0;  ///< of solver, elements and states
  double step_seconds() const { return evaluate_seconds + factor_seconds + solve_seconds + other_seconds; }
};

struct OutlookDecision {
  plan::Decision decision;
  bool has_saving = false;  ///< it is taken and can be excluded
  Effort without;           ///< cost of a step without this decision
};

/// A run beside the run, which measures an error of it (scene::ErrorsWanted).
struct OutlookTwin {
  std::string what;                          ///< "steps 2 times as long", "0.5 times as many elements"
  double seconds = 0.0, memory_bytes = 0.0;  ///< those of the run, in the proportion of their estimates (Estimate)
};

struct Outlook {
  std::string scene, title;
  std::size_t nodes = 0, elements = 0, joints = 0;
  std::int64_t unknowns_in_space = 0;  ///< six per node, and every row of every joint
  std::string motions;                 ///< "in space", "in a plane", ...
  std::string cut;                     ///< how the tree was made
  int sub_domains = 0, leaves = 0, levels = 0, fronts_in_lanes = 0, fronts = 0;
  Effort effort;
  double steps = 0.0;              ///< equal steps or load steps; with error control, as many as of the first size
  std::int64_t process_bytes = 0;  ///< estimated peak of the process: the program, memory_bytes and those of twins
  plan::Mobility mobility;
  std::vector<OutlookDecision> decisions;
  std::vector<OutlookTwin> twins;
  std::vector<std::string> notes;
};

/// Builds plan, tree and solver of a scene, once as given and once without each decision that can be excluded. Takes up
/// to 2048 steps of a run, once for all decisions but those that change the iteration; fewer where steps are
/// long, none where eight would take a second by the model. The numbers of work per step that they give do not depend
/// on the machine; the seconds do, and vary from call to call. Costs without a decision are those of the model, times
/// the ratio of measured and modelled time: of own trial steps where the decision changes the iteration, and otherwise
/// of the scene as given.
/// Precondition: problems_in(scene) is empty.
Outlook look_ahead(const scene::Scene& scene);

/// Seconds that a run of the scene will take on one thread, with its preparation and without its files: the step is that
/// of trial steps on this machine, as look_ahead takes them, or of the model where these would take too long. Takes up
/// to some .2 s, or the time of the fewest trial steps. Precondition: problems_in(scene) is empty.
double forecast_seconds(const scene::Scene& scene);

}  // namespace bough::run
