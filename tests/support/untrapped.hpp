#pragma once

#include <fenv.h>

namespace bough::test {

/// Masks the floating-point traps of this thread during its lifetime, for tests that make infinities or NaN on purpose.
class Untrapped {
 public:
  Untrapped() { feholdexcept(&saved_); }
  ~Untrapped() { fesetenv(&saved_); }
  Untrapped(const Untrapped&) = delete;
  Untrapped& operator=(const Untrapped&) = delete;

 private:
  fenv_t saved_{};
};

}  // namespace bough::test
