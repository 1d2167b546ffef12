#pragma once
/// What static analyses have in common.
#include "analysis.hpp"
#include "stability_watch.hpp"

namespace bough::run {

/// Common base of static analyses, which watch the stability of the equilibria that they find.
class Statics : public Analysis {
 public:
  void sum_up() override;
  void add_doubts() override;
  std::string not_judged() const override;
  void checkpoint(records::Archive& archive) override {
    Analysis::checkpoint(archive);
    archive(stability_);
  }

 protected:
  explicit Statics(const Parts& parts) : Analysis(parts), stability_(parts.scene, parts.system) {}
  Statics(const Statics&) = default;

  StabilityWatch stability_;
};

}  // namespace bough::run
