#pragma once
/// Digits of reactions in time. Near positions in which constraints come to depend on each other, multipliers answer
/// to gaps of joints with
///   (G S^-1 G^T)^-1 gap,   S^-1 about beta h^2 M^-1,
/// so that what round-off and the tolerance leave of gaps may be as large as the reaction itself. Positions and
/// velocities do not show it. Where they pass through such a position reactions have a pole, c / (t - t0) + b, as those
/// of bars that pull along a line that they do not leave: how large they are at the steps next to it hangs on where
/// these fall, so that a small delay of the motion makes large errors.
#include <optional>
#include <string>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// Watches the joints whose reactions sensors show. A reaction that bends from step to step by more than a small part
/// of itself is looked at: what one more correction, S^-1 (-residual), changes of it is what is not determined. Where
/// a look finds nothing in this step and the next ones, further ones wait for twice that bend, which fades in some
/// hundred steps: reactions that vibrate cost a few looks in a hundred steps.
class ReactionWatch {
 public:
  explicit ReactionWatch(const step::System& system);

  /// A start, or the far side of a jump: reactions before it say nothing.
  void restart() { num_known_ = 0; }
  /// To be called for every accepted step: whether its reactions are to be looked at. drift: the sum of local errors
  /// so far, of the size of the structure or rad.
  bool wants_look(const step::State& state, double drift);
  /// Looks at them. The state must be whole, laws those of its time, the factor that of its step. Overwrites the
  /// residual and the right-hand side.
  [[nodiscard]] std::optional<step::Trouble> look(step::System& system, const step::State& state);
  /// What looks have found, by joint: its least determined reaction.
  std::vector<records::UnsureReaction> found() const;
  /// Of reactions that passed a pole: the one whose value there is most wrong, since the motion comes to it at another
  /// time, in words; empty: none is by more than a hundredth of its largest.
  std::string misplaced() const;

 private:
  struct Row {
    std::size_t multiplier;
    std::size_t unknown;
    double weight;  ///< 1, of a moment 1/arm [1/m]: multipliers times this are forces [N]
    double before = 0.0, before_that = 0.0, first = 0.0;  ///< one, two and three steps ago
  };
  struct Watched {
    int joint = -1;
    std::vector<Row> rows;
    double largest = 0.0;  ///< reaction so far [N]
    double bend = 0.0,
           quiet = 0.0;  ///< second difference of the reaction now; the largest that was looked at, fading [N]
    records::UnsureReaction found;
    double steepness = 0.0;                  ///< at a pole now, else 0 [N a step]
    double shifted = 0.0, shifted_at = 0.0;  ///< what the estimated delay of the motion changes at a pole, and when [N]
  };
  /// Change per step at the steeper one of the last two steps but one, where the last four lie on a pole; else 0 [N].
  static double steepness_at_pole(const Row& row, double now, double scale);
  double delay(const step::State& state) const;
  double scale_of(const Watched& w) const;

  const plan::Plan& plan_;
  std::vector<Watched> joints_;
  double largest_ = 0.0;  ///< of all
  int num_known_ = 0;     ///< steps before this one whose reactions are known, up to 2
  int num_due_ = 0;       ///< steps after the last look that are looked at, too
  int num_equal_ = 0;     ///< steps of one size up to this one, up to 3
  double step_size_ = 0.0, drift_ = 0.0;
};

}  // namespace bough::run
