#pragma once
/// Forces of stiff parts far from the origin, where places have few digits left.
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/records/archive.hpp"

namespace bough::run {

/// A place x is known to u |x|, u being the unit round-off, and a section force of an element of length L to
///   EA u |x| / L                                        (GA for shear)
/// Watches the section forces of beams whose places are more than 1e4 elements away from the origin.
class FarWatch {
 public:
  explicit FarWatch(const plan::Plan& plan);
  bool is_empty() const { return forces_.empty(); }
  /// Takes the values of all sensors at a row.
  void see(const std::vector<double>& values);
  /// The force that has the fewest digits, in words; empty: all have enough.
  std::string text() const;
  void checkpoint(records::Archive& archive) { archive(forces_); }

 private:
  struct Force {
    std::size_t column;
    std::string name;
    double noise;          ///< EA u |x| / L [N]
    double distance;       ///< |x| [m]
    double largest = 0.0;  ///< so far [N]
    std::size_t sensor;
    void checkpoint(records::Archive& archive) { archive(largest); }
  };
  std::vector<Force> forces_;
};

}  // namespace bough::run
