// The smallest user of the installed package: headers are found, targets link, the version is the package's.
#include <cstdio>

#include "bough/version.hpp"

int main() {
  std::printf("bough %.*s\n", static_cast<int>(bough::version.size()), bough::version.data());
  return bough::version == EXPECTED_VERSION ? 0 : 1;
}
