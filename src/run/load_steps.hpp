#pragma once
/// Statics by load steps.
#include <memory>
#include <string>
#include <vector>

#include "statics.hpp"

namespace bough::run {

/// Load steps of equal width. A load step is divided at load factors at which figures are requested. A failed step is
/// halved, and doubled again after success. Where no number of halvings is asked for, there are more of them than the
/// default: a line that hangs slack, or what the first shape hardly holds, moves far under a small part of its load.
class LoadSteps final : public Statics {
 public:
  explicit LoadSteps(const Parts& parts);
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<LoadSteps>(*this); }
  bool begin() override;
  bool take_step() override;
  bool is_done() const override { return step_ == num_steps_; }
  void add_doubts() override;
  void add_notes() override;
  void checkpoint(records::Archive& archive) override {
    Statics::checkpoint(archive);
    archive(step_, stops_, next_stop_, from_, level_, part_, jumps_, most_level_, most_cut_at_);
  }

 private:
  void begin_load_step();
  int most_cuts() const;
  std::string ways_on() const;

  int num_steps_, step_ = 0;   ///< number of load steps, and index of the present one
  std::vector<double> stops_;  ///< load factors at which its parts end
  std::size_t next_stop_ = 0;
  double from_ = 0.0;   ///< load factor at the start of the present part
  int level_ = 0;       ///< the part is cut into 2^level steps
  long part_ = 0;       ///< number of these steps done
  step::State before_;  ///< start of the present step
  std::string jumps_;   ///< load factors between which the structure jumped to another branch
  int most_level_ = 0;  ///< largest level at which a step was taken, and the load factor from which
  double most_cut_at_ = 0.0;
};

}  // namespace bough::run
