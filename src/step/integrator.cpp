#include "bough/step/integrator.hpp"

#include "bdf.hpp"
#include "variational.hpp"

namespace bough::step {

namespace {

/// Generalized-alpha. All of its vectors are in the state, where local errors and predictors read them.
class GeneralizedAlpha final : public Integrator {
 public:
  explicit GeneralizedAlpha(System& system) : system_(system) {}
  std::unique_ptr<Integrator> clone() const override { return std::make_unique<GeneralizedAlpha>(*this); }
  StartReport start(State& state, const StepOptions& options, double step_size) override {
    return start_alpha(system_, state, options, step_size);
  }
  StartReport change_step_size(State& state, const StepOptions& options, double step_size) override {
    return step::change_step_size(system_, state, options, step_size);
  }
  StepReport advance(State& state, const StepOptions& options, double end_time) override {
    return step::advance(system_, state, options, end_time);
  }

 private:
  System& system_;
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(System& system, const scene::Solver& solver, const StepOptions& options) {
  switch (options.integrator) {
    case scene::Integrator::bdf:
      return std::make_unique<Bdf>(system, options.bdf_order);
    case scene::Integrator::variational:
      return make_variational(system, solver, options.newmark_beta);
    case scene::Integrator::generalized_alpha:
      break;
  }
  return std::make_unique<GeneralizedAlpha>(system);
}

}  // namespace bough::step
