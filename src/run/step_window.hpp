#pragma once
/// What sensors show between the ends of steps.
#include <array>
#include <span>
#include <vector>

#include "bough/results/observe.hpp"

namespace bough::run {

/// The ends of up to four steps in a row of one smooth stretch, as some sensors see them. Between two of them
/// - sensors of motion (results::shows_motion) are evaluated on nodes interpolated by step::eval_between, of order
///   h^4 in places;
/// - all others take the polynomial through their values at the ends: with four of them of order h^4. (A stiff part's
///   force evaluated on
///   interpolated nodes would be off by its stiffness times an error of order h^4, which no balance takes back.)
/// Nothing is interpolated across a start or a breakpoint, where a window is begun anew.
class StepWindow {
 public:
  static constexpr int most_ends = 4;

  /// sensors: places in Plan::sensors, ascending.
  StepWindow(const plan::Plan& plan, std::vector<int> sensors);

  const std::vector<int>& sensors() const { return sensors_; }
  void clear() { num_ends_ = 0; }
  /// Takes the end of a step; beyond four the first is forgotten. Laws stand at its time.
  void push(const step::System& system, const step::State& state, results::EnergyMeter& meter);

  int num_ends() const { return num_ends_; }
  double time(int end) const { return ends_[static_cast<std::size_t>(end)].time; }
  /// Values of the sensor `sensors()[k]` at an end.
  std::span<const double> values(int end, int k) const;
  /// The same at a time between the ends `interval` and `interval` + 1; no values where a law is not finite there.
  /// Good until the next call. Where frames move, the laws of the system then stand at this time: the caller puts
  /// them back.
  std::span<const double> values_between(step::System& system, results::EnergyMeter& meter, int interval, double time,
                                         int k);

 private:
  struct End {
    double time = 0.0;
    std::vector<elements::NodeMotion> nodes;  ///< of nodes_
    std::vector<double> turns;                ///< of all joints
    std::vector<double> values;               ///< of sensors_, one after the other
  };

  const plan::Plan& plan_;
  std::vector<int> sensors_;
  std::vector<std::vector<int>> nodes_of_;  ///< of each sensor of motion: places in nodes_
  std::vector<std::size_t> value_begin_;    ///< of each sensor, and the end
  std::vector<int> nodes_;                  ///< that sensors of motion look at
  std::array<End, most_ends> ends_;
  int num_ends_ = 0;
  std::vector<elements::NodeMotion> between_nodes_;  ///< scratch of push
  step::State between_;                              ///< only what sensors of motion look at is set
  std::vector<double> found_;
};

}  // namespace bough::run
