#pragma once
/// Springs that pass through length 0, where the direction of their force is not defined and turns round.
#include <string>
#include <vector>

#include "bough/step/system.hpp"

namespace bough::results {

/// Compares the springs of a scene from look to look. A spring with a rest length has passed through length 0 where
/// its ends approached each other along its line at the last look, move apart along it now, and its direction has
/// turned round: turning alone does not look so.
class SpringWatch {
 public:
  explicit SpringWatch(const plan::Plan& plan);

  /// At the rows of a history; takes no memory.
  void look(const step::System& system, const step::State& state);

  /// The first spring that passed, with the time, in words; empty: none did.
  std::string text() const;

 private:
  struct Seen {
    int spring = 0;  ///< in the array of springs
    std::string name;
    motion::Vec3<double> span = motion::Vec3<double>::zero();
    motion::Vec3<double> approach =
        motion::Vec3<double>::zero();  ///< its change since the look before; at first its rate
  };
  static motion::Vec3<double> rate_of(const elements::Spring& spring, const elements::Field& field);

  std::vector<Seen> seen_;
  bool is_first_ = true;
  const Seen* passed_ = nullptr;
  double time_ = 0.0;
};

}  // namespace bough::results
