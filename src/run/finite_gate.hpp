#pragma once
/// The gate at the end of a run: what is not a finite number does not pass as a result.
#include <cmath>
#include <string>
#include <string_view>

#include "bough/records/run.hpp"
#include "bough/results/energies.hpp"
#include "bough/step/state.hpp"

namespace bough::run {

/// Looks at everything that a run hands out, and keeps in words the first thing that is not a finite number. A number
/// is looked at where it is made: the largest of several forgets one that is not a number.
class FiniteGate {
 public:
  void look_at(const records::HistoryHeader& header, const records::HistoryRow& row);
  void look_at(const records::MotionFrame& frame);
  /// `frame`: the structure at this time, to name the part that is farthest away; asked for only where something is
  /// wrong.
  template <class Frame>
  void look_at(const results::Energies& energies, double time, const Frame& frame) {
    const std::string_view name = not_finite_in(energies);
    if (!name.empty() && cause_.empty()) fail(time, std::string(name) + worst_part(frame()));
  }
  void look_at(const step::State& state, const plan::Plan& plan);
  void look_at(const records::Summary& summary);
  /// One number of the run by its name.
  void look_at(std::string_view name, double value, double time) {
    if (!std::isfinite(value)) fail_at(name, value, time);
  }

  /// Empty where all that was looked at is finite; else the time, what is not finite, where, and what to do.
  const std::string& cause() const { return cause_; }

 private:
  static std::string_view not_finite_in(const results::Energies& energies);
  static std::string worst_part(const records::MotionFrame& frame);
  void fail_at(std::string_view name, double value, double time);
  void fail(double time, const std::string& what);

  std::string cause_;
};

}  // namespace bough::run
