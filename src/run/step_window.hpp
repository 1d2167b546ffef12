#pragma once
/// Interpolation of sensors between the ends of steps.
#include <array>
#include <span>
#include <vector>

#include "bough/results/observe.hpp"

namespace bough::run {

/// Values of some sensors at up to four consecutive ends of steps of one smooth stretch. Between two ends
/// - sensors of motion (results::shows_motion) are evaluated on nodes interpolated by step::eval_between, of order
///   h^4 in places;
/// - all others take the polynomial through their values at the ends: with four of them of order h^4. (A stiff part's
///   force evaluated on
///   interpolated nodes would be off by its stiffness times an error of order h^4, which no balance takes back.)
/// A new window begins at a start or breakpoint, so that nothing is interpolated across it.
class StepWindow {
 public:
  static constexpr int most_ends = 4;

  /// sensors: indices in Plan::sensors, ascending.
  StepWindow(const plan::Plan& plan, std::vector<int> sensors);

  const std::vector<int>& sensors() const { return sensors_; }
  void clear() { num_ends_ = 0; }
  /// Adds the end of a step, and drops the first if there were four. Laws must be set to its time.
  void push(const step::System& system, const step::State& state, results::EnergyMeter& meter);

  int num_ends() const { return num_ends_; }
  void checkpoint(records::Archive& archive) { archive(ends_, num_ends_); }
  double time(int end) const { return ends_[static_cast<std::size_t>(end)].time; }
  /// Values of the sensor `sensors()[k]` at an end.
  std::span<const double> values(int end, int k) const;
  /// Values at a time between the ends `interval` and `interval` + 1; empty if a law is not finite there. Valid until
  /// the next call. In a scene with moving frames this sets the laws of the system to `time`, and the caller has to
  /// reset them.
  std::span<const double> values_between(step::System& system, results::EnergyMeter& meter, int interval, double time,
                                         int k);

 private:
  struct End {
    double time = 0.0;
    std::vector<elements::NodeMotion> nodes;  ///< motions of nodes_
    std::vector<double> turns;                ///< angles of all joints
    std::vector<double> values;               ///< values of sensors_, one after the other
    void checkpoint(records::Archive& archive) { archive(time, nodes, turns, values); }
  };

  const plan::Plan& plan_;
  std::vector<int> sensors_;
  std::vector<std::vector<int>> nodes_of_;  ///< by sensor of motion: indices in nodes_
  std::vector<std::size_t> value_begin_;    ///< by sensor: offset in End::values; and their number
  std::vector<int> nodes_;                  ///< nodes used by sensors of motion
  std::array<End, most_ends> ends_;
  int num_ends_ = 0;
  step::State between_;  ///< only the data used by sensors of motion are set, which push overwrites
  std::vector<double> found_;
};

}  // namespace bough::run
