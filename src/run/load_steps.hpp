#pragma once
/// Statics by load steps.
#include <vector>

#include "analysis.hpp"
#include "stability_watch.hpp"

namespace bough::run {

/// What all of statics does: it watches the stability of the equilibria that it finds.
class Statics : public Analysis {
 public:
  void sum_up() override;

 protected:
  explicit Statics(const Parts& parts) : Analysis(parts), stability_(parts.scene, parts.system) {}
  Statics(const Statics&) = default;

  StabilityWatch stability_;
};

/// Load steps of equal width; one within which a figure is asked for ends there, and goes on to its own end. A step
/// that fails is halved, and doubled again after success.
class LoadSteps final : public Statics {
 public:
  explicit LoadSteps(const Parts& parts);
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<LoadSteps>(*this); }
  bool begin() override;
  bool take_step() override;
  bool is_done() const override { return step_ == num_steps_; }

 private:
  void begin_load_step();

  int num_steps_, step_ = 0;   ///< load steps of equal width: all, and the present one
  std::vector<double> stops_;  ///< load factors at which it ends, or a part of it
  std::size_t next_stop_ = 0;
  double from_ = 0.0;  ///< where the way to the next stop begins
  int level_ = 0;      ///< the way there is cut into 2^level steps
  long part_ = 0;      ///< of which so many are done
};

}  // namespace bough::run
