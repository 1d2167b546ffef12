#pragma once
/// Accuracy of reactions in dynamics. Near positions in which constraints become linearly dependent, constraint
/// violations (gaps of joints) cause multipliers of
///   (G S^-1 G^T)^-1 gap,   S^-1 about beta h^2 M^-1,
/// Gaps left by round-off and the tolerance can then cause errors as large as the reaction itself, although positions
/// and velocities are accurate. When a motion passes through such a position, reactions may have a pole, c / (t - t0) +
/// b, as with bars that pull along a line that they do not leave. The reactions at the adjacent steps depend on the
/// times of these steps relative to t0, so that a small delay of the motion causes large errors.
#include <optional>
#include <string>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// Watches the joints whose reactions are shown by sensors. If the second difference of a reaction over steps exceeds a
/// small part of the largest reaction, the reaction is checked: the change of it by one more Newton correction, S^-1
/// (-residual), estimates its error. After a check, the threshold is twice the second difference that was checked,
/// which decays over some hundred steps. Reactions that vibrate thus cost a few checks per hundred steps.
class ReactionWatch {
 public:
  explicit ReactionWatch(const step::System& system);

  /// Forgets earlier reactions, at a start or after a jump in a load or motion.
  void restart() { num_known_ = 0; }
  /// Adds an accepted step, and returns whether its reactions should be checked by `look`. drift: sum of the local
  /// errors so far, relative to the size of the structure or in rad.
  bool wants_look(const step::State& state, double drift);
  /// Checks the reactions. The state must be complete, laws must be set to its time, and the factorization must be that
  /// of its step size. Overwrites the residual and the right-hand side.
  [[nodiscard]] std::optional<step::Trouble> look(step::System& system, const step::State& state);
  /// For each joint, the reaction with the largest estimated error.
  std::vector<records::UnsureReaction> found() const;
  /// Describes the reaction with the largest error next to a pole, caused by the estimated delay of the motion. Empty
  /// if no such error is above about a hundredth of the largest reaction.
  std::string misplaced() const;
  void checkpoint(records::Archive& archive) {
    archive(joints_, largest_, num_known_, num_due_, num_equal_, step_size_, drift_);
  }

 private:
  struct Row {
    std::size_t multiplier;
    std::size_t unknown;
    double weight;  ///< 1, or 1/arm [1/m] for a moment: converts multipliers to forces [N]
    double before = 0.0, before_that = 0.0, first = 0.0;  ///< values one, two and three steps ago
  };
  struct Watched {
    int joint = -1;
    std::vector<Row> rows;
    double largest = 0.0;  ///< largest reaction so far [N]
    double bend = 0.0,
           quiet = 0.0;  ///< second difference now; decaying maximum of those checked [N]
    records::UnsureReaction found;
    double steepness = 0.0;                  ///< change per step next to a pole, else 0 [N]
    double shifted = 0.0, shifted_at = 0.0;  ///< largest error at a pole due to the delay [N]; its time
    void checkpoint(records::Archive& archive) {
      archive(rows, largest, bend, quiet, found, steepness, shifted, shifted_at);
    }
  };
  /// If the last four values lie on a pole, the steeper of the slopes at the two inner ones [N per step]; else 0.
  static double steepness_at_pole(const Row& row, double now, double scale);
  double delay(const step::State& state) const;
  double scale_of(const Watched& w) const;

  const plan::Plan& plan_;
  std::vector<Watched> joints_;
  double largest_ = 0.0;  ///< reaction of all joints so far [N]
  int num_known_ = 0;     ///< number of earlier steps with known reactions, at most 2
  int num_due_ = 0;       ///< number of further steps to be checked
  int num_equal_ = 0;     ///< number of steps of equal size up to this one, at most 3
  double step_size_ = 0.0, drift_ = 0.0;
};

}  // namespace bough::run
