#include "register_scales.hpp"

namespace bough::solve {

namespace {

std::int64_t size_of(const RegisterFront& f) {  // columns, inverse columns, limits: whole registers of each may be read
  return (f.step() + 2 * f.eliminated + row_register - 1) / row_register * row_register;
}

std::int64_t size_of_all(const RegisterPlan& plan) {
  std::int64_t size = 0;
  for (const RegisterFront& f : plan.fronts) size += size_of(f);
  return size;
}

}  // namespace

RegisterScaleStore::RegisterScaleStore(const RegisterPlan& plan)
    : numbers_(static_cast<std::int64_t>(plan.fronts.size()), size_of_all(plan)) {}

void RegisterScaleStore::set(const RegisterPlan& plan, const Scales& scales, double least) {
  numbers_.clear();
  for (const RegisterFront& f : plan.fronts) {
    double* column = numbers_.begin(size_of(f), 0.0);
    double *inverse = column + f.step(), *bar = inverse + f.eliminated;
    for (int r = f.own_begin; r < f.boundary_end; ++r) {
      const UnknownRun& run = plan.unknown_runs[static_cast<std::size_t>(r)];
      for (int i = 0; i < run.length; ++i) {
        const auto u = static_cast<std::size_t>(run.unknown + i);
        const int row = run.row + i;
        column[row] = scales.column[u];
        if (row >= f.eliminated) continue;
        inverse[row] = 1.0 / scales.column[u];
        bar[row] = least * inverse[row] / scales.row[u];
      }
    }
    numbers_.end();
  }
}

}  // namespace bough::solve
