#pragma once
/// Statics by load steps.
#include <memory>
#include <vector>

#include "statics.hpp"

namespace bough::run {

/// Load steps of equal width. A load step is divided at load factors at which figures are requested. A failed step is
/// halved, and doubled again after success.
class LoadSteps final : public Statics {
 public:
  explicit LoadSteps(const Parts& parts);
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<LoadSteps>(*this); }
  bool begin() override;
  bool take_step() override;
  bool is_done() const override { return step_ == num_steps_; }
  void add_doubts() override;

 private:
  void begin_load_step();

  int num_steps_, step_ = 0;   ///< number of load steps, and index of the present one
  std::vector<double> stops_;  ///< load factors at which its parts end
  std::size_t next_stop_ = 0;
  double from_ = 0.0;  ///< load factor at the start of the present part
  int level_ = 0;      ///< the part is cut into 2^level steps
  long part_ = 0;      ///< number of these steps done
  step::State before_;        ///< start of the present step
  std::string jumps_;         ///< load factors between which the structure jumped to another branch
};

}  // namespace bough::run
