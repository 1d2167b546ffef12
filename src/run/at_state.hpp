#pragma once
#include "about_state.hpp"
#include "analysis.hpp"

namespace bough::run {

/// Base of analyses that look at the linearised equations about one state.
class AtState : public Analysis {
 public:
  bool begin() final;
  bool take_step() final;
  bool is_done() const final { return is_done_; }
  bool ends_in_correction() const final { return false; }
  void checkpoint(records::Archive& archive) override {
    Analysis::checkpoint(archive);
    archive(is_done_, about_);
  }
  void add_doubts() override;

 protected:
  explicit AtState(const Parts& parts)
      : Analysis(parts), about_(parts.scene, parts.system, parts.state, parts.options) {}
  AtState(const AtState&) = default;

  /// What the analysis is for. False: it has failed.
  virtual bool look(step::Linearisation& linear) = 0;
  void tell_notes();  ///< of the state

  AboutState about_;

 private:
  bool is_done_ = false;
};

}  // namespace bough::run
