#pragma once
/// What surrounds a scene at one time: values of its time functions, and frames of prescribed motion.
#include <optional>
#include <span>
#include <vector>

#include "bough/elements/evaluate.hpp"
#include "bough/lanes/taylor.hpp"
#include "bough/plan/frames.hpp"
#include "bough/plan/plan.hpp"
#include "bough/step/state.hpp"
#include "bough/step/trouble.hpp"

namespace bough::step {

class Instant {
 public:
  using Series = std::vector<lanes::Taylor<double, 3>>;

  explicit Instant(const plan::Plan& plan);

  /// Left or right limit at t. A value that is not finite is told with its owner and the time.
  [[nodiscard]] std::optional<Trouble> set(double time, laws::Side side);
  double time() const { return time_; }
  laws::Side side() const { return side_; }

  /// Values of laws, and of signals as they were in the state of the last field made here.
  const std::vector<double>& law_values() const { return values_; }
  /// Changes the value of a signal in these.
  void note_signal(const plan::SignalPlan& signal, double value) const {
    values_[static_cast<std::size_t>(signal.law)] = value;
  }
  /// Motion of the frame in which everything is described, in the inertial one; null where that is the inertial frame
  /// itself.
  const elements::CarrierMotion* observer() const { return plan_.observer < 0 ? nullptr : &frames_.observer; }
  const plan::FrameMotions& frames() const { return frames_; }
  /// Gravity, laws and frames with the nodes of a state in space, whatever the group of the scene: what elements,
  /// sensors and balances in space evaluate. The field refers to the state.
  elements::Field field(const State& state, const elements::Slopes& slopes = {}, bool with_inertia = true) const;
  /// The same with some of the nodes only; the others must not be read. scratch: holds these nodes. walker: null for
  /// one thread.
  elements::Field field_of(const State& state, std::span<const int> nodes, std::vector<elements::NodeMotion>& scratch,
                           const tree::Walker* walker = nullptr) const;
  /// The same with the nodes on the group G, which must be SE(3) or the group of the scene.
  template <class G>
  elements::FieldOn<G, double> field_on(const State& state, const elements::Slopes& slopes = {},
                                        bool with_inertia = true) const;

  /// Laws with their first derivative, and with three. They tell two: the third is a one-sided difference over a step
  /// to come, 0 where `step_size` is, since it enters terms of order h^2 alone. Kept until asked for again.
  const std::vector<lanes::Taylor<double, 1>>& rate_series() const;
  const Series& series(double step_size) const;
  /// Frames whose laws have that third derivative.
  const plan::FrameMotions& frame_series(double step_size) const;

 private:
  void set_frames();
  void set_turned_laws();
  /// All of a field but the nodes.
  elements::Field surroundings(const State& state, const elements::Slopes& slopes, bool with_inertia) const;

  const plan::Plan& plan_;
  double time_ = 0.0;
  laws::Side side_ = laws::Side::left;
  mutable std::vector<double> values_;         ///< of laws; those of signals are taken from states
  std::vector<double> rates_, accelerations_;  ///< of laws
  plan::FrameMotions frames_;
  mutable plan::FrameMotions series_frames_;  ///< scratch, as the next two
  mutable Series series_;
  mutable std::vector<lanes::Taylor<double, 1>> rate_series_;
};

}  // namespace bough::step
