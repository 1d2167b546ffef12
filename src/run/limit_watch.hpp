#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/records/archive.hpp"
#include "bough/step/step_control.hpp"

namespace bough::run {

/// Counts which errors limited the step sizes of step control.
class LimitWatch {
 public:
  explicit LimitWatch(const plan::Plan& plan);
  /// Counts an accepted step whose size was limited by an error, or by the largest size allowed.
  void count(const step::ErrorLimit& limit);
  void count_largest() { ++at_largest_; }
  void checkpoint(records::Archive& archive) { archive(of_beam_, of_node_, of_signal_, at_largest_, of_energy_, all_); }
  /// A note on the most frequent limit; none if nothing was counted.
  std::optional<std::string> text(const plan::Plan& plan, double tolerance) const;

 private:
  struct Limit {
    long steps = 0, of_velocity = 0;
    double frequencies = 0.0;  ///< summed over the steps [rad/s]
  };
  std::vector<int> owner_;  ///< by node: the beam whose inner node it is, or -1
  std::vector<Limit> of_beam_, of_node_;
  std::vector<long> of_signal_;
  long at_largest_ = 0, of_energy_ = 0, all_ = 0;
};

}  // namespace bough::run
