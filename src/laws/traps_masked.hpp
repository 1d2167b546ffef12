#pragma once
#include <cfenv>

namespace bough::laws {

/// Masks floating-point traps during its lifetime; the caller handles infinities and NaN.
class TrapsMasked {
 public:
  TrapsMasked() { std::feholdexcept(&environment_); }
  TrapsMasked(const TrapsMasked&) = delete;
  TrapsMasked& operator=(const TrapsMasked&) = delete;
  ~TrapsMasked() { std::fesetenv(&environment_); }

 private:
  std::fenv_t environment_{};
};

}  // namespace bough::laws
