#pragma once
/// Load factors next to an equilibrium at which its tangent becomes singular.
#include <string>
#include <vector>

#include "bough/step/linearisation.hpp"

namespace bough::step {

/// A vector x and the distance d of a load factor at which  (K + d K') x + G^T y = 0,  G x = 0.
struct CriticalLoad {
  double distance = 0.0;
  std::vector<double> shape;  ///< by unknown, with the multipliers that belong to it; of unit length in `weights`
};

struct CriticalLoads {
  std::string cause;                ///< why none is known; empty: they are
  std::vector<CriticalLoad> loads;  ///< of both signs, the nearest first
  int unstable = -1;                ///< negative eigenvalues of K on the motions that constraints allow; -1: not known
};

/// `linear` holds the tangent as K and -K' as M (Linearisation::add_difference). Eigenvalues 1 / d of  [K G^T; G
/// 0]^-1 (-K')  by Arnoldi's method, real ones alone, so that under loads without a potential divergence is found and
/// flutter is not. Further searches, beside those that were found and are locked, find equal ones. symmetric: K and K'
/// are, and their symmetric parts are factored.
CriticalLoads find_critical_loads(Linearisation& linear, bool symmetric, int count);

}  // namespace bough::step
