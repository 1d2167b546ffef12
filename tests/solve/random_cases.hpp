#pragma once
/// Hundreds of random scenes, each a function of its number alone, with what they are known to hold. Test data only.
#include <utility>
#include <vector>

#include "random_scene.hpp"

namespace bough::test {

constexpr int num_case_families = 10;

struct Case {
  Scene scene;
  int family = 0;
  int leaf_size = 0;                        ///< for the tree
  std::vector<std::pair<int, int>> copies;  ///< (joint, joint whose rows are combinations of its): elements

  int deficiency() const;
  /// Null vectors, unscaled, one a column; those of the transpose are the same.
  Eigen::MatrixXd null_vectors() const;
};

/// Case `number`: family number mod 10 (chain, tree, loop, star, lattice, parts, rigid chain, joints everywhere;
/// equal arms of which one has a node without mass between joints; equal arms of which one has a dependent
/// constraint), about `unknowns` unknowns, stiffness ratios of 1 to 1e12 between beams, time steps of 1e-6 to 1e-2 s;
/// in four of ten, some joints twice.
Case make_case(int number, int unknowns);

/// Sizes from 1 to 1500, evenly by their logarithm; number 249: 2500, number 499: 5000. Scenes come out near that.
int unknowns_of_case(int number);

/// How many of them this program is to try: fewer in the unit tests.
int num_cases();

}  // namespace bough::test
