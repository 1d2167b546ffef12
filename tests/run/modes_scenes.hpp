#pragma once
/// Modes of a scene as its table tells them.
#include <gtest/gtest.h>

#include <complex>
#include <string>
#include <utility>
#include <vector>

#include "support/scenes.hpp"
#include "table_seen.hpp"

namespace bough::verify {

/// The table of modes of a run.
class ModesSeen : public TableSeen {
 public:
  explicit ModesSeen(const scene::Scene& scene) : ModesSeen(support::run(scene)) {}
  std::complex<double> eigenvalue(std::size_t row) const {
    return {number(row, "real_part"), number(row, "imaginary_part")};
  }
  /// Angular frequencies of vibrations, ascending [rad/s].
  std::vector<double> frequencies() const {
    std::vector<double> all;
    for (std::size_t k = 0; k < count(); ++k)
      if (number(k, "angular_frequency") > 0.0) all.push_back(number(k, "angular_frequency"));
    return all;
  }
  double largest_residual() const {
    double most = 0.0;
    for (std::size_t k = 0; k < count(); ++k) most = std::max(most, number(k, "residual"));
    return most;
  }
  bool says(const std::string& words) const { return table().about.find(words) != std::string::npos; }
  std::size_t count_of(const std::string& kind) const {
    std::size_t found = 0;
    for (std::size_t k = 0; k < count(); ++k) found += text(k, "kind") == kind ? 1 : 0;
    return found;
  }

  support::Outcome outcome;

 private:
  explicit ModesSeen(support::Outcome of) : TableSeen(of), outcome(std::move(of)) {
    EXPECT_TRUE(outcome.ok()) << outcome.summary.cause;
  }
};

/// Square steel bar of .1 m.
inline const char* const square_bar =
    R"("materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
       "sections": [{"name": "bar", "shape": {"kind": "rectangle", "width": 0.1, "height": 0.1}, "material": "steel"}],)";

}  // namespace bough::verify
