#pragma once
/// Detects springs that pass through length 0, where the direction of their force is undefined and reverses.
#include <optional>
#include <string>
#include <vector>

#include "bough/step/system.hpp"

namespace bough::results {

/// Compares springs, all couplings that act along a line, between consecutive calls. One with a rest length has passed
/// through length 0 if its ends approached each other along its line at the last call, move apart along it now, and its direction has
/// reversed. A rotation without a passage does not satisfy these conditions.
class SpringWatch {
 public:
  explicit SpringWatch(const plan::Plan& plan);

  /// Call it at the rows of a history. Does not allocate.
  void look(const step::System& system, const step::State& state);

  void checkpoint(records::Archive& archive) { archive(seen_, is_first_, passed_, time_); }

  /// Describes the first spring that passed through length 0, with the time; empty if none did.
  std::string text() const;

 private:
  struct Seen {
    elements::Port ports[2];
    std::string name;
    motion::Vec3<double> span = motion::Vec3<double>::zero();
    motion::Vec3<double> approach =
        motion::Vec3<double>::zero();  ///< change of the vector between its ends since the previous call; at first its
                                       ///< rate
    void checkpoint(records::Archive& archive) { archive(span, approach); }
  };
  static motion::Vec3<double> rate_of(const Seen& spring, const elements::Field& field);

  std::vector<Seen> seen_;
  bool is_first_ = true;
  std::optional<std::size_t> passed_;  ///< in seen_
  double time_ = 0.0;
};

}  // namespace bough::results
