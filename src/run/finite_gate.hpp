#pragma once
/// Check that all results of a run are finite numbers.
#include <cmath>
#include <string>
#include <string_view>

#include "bough/records/run.hpp"
#include "bough/results/energies.hpp"
#include "bough/step/state.hpp"

namespace bough::run {

/// Checks all results of a run, and keeps a description of the first one that is not finite. Numbers are checked where
/// they are computed, because a maximum over several numbers may discard a NaN.
class FiniteGate {
 public:
  void look_at(const records::HistoryHeader& header, const records::HistoryRow& row);
  void look_at(const records::MotionFrame& frame);
  /// frame: returns the structure at this time, to name the part that is farthest away. Called only if a number is not
  /// finite.
  template <class Frame>
  void look_at(const results::Energies& energies, double time, const Frame& frame) {
    const std::string_view name = not_finite_in(energies);
    if (!name.empty() && cause_.empty()) fail(time, std::string(name) + worst_part(frame()));
  }
  void look_at(const step::State& state, const plan::Plan& plan);
  void look_at(const records::Summary& summary);
  /// Checks one number, described by a name.
  void look_at(std::string_view name, double value, double time) {
    if (!std::isfinite(value)) fail_at(name, value, time);
  }

  /// Empty if everything checked is finite; else the time, what is not finite, where, and what to do.
  const std::string& cause() const { return cause_; }
  void checkpoint(records::Archive& archive) { archive(cause_); }

 private:
  static std::string_view not_finite_in(const results::Energies& energies);
  static std::string worst_part(const records::MotionFrame& frame);
  void fail_at(std::string_view name, double value, double time);
  void fail(double time, const std::string& what);

  std::string cause_;
};

}  // namespace bough::run
