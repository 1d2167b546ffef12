#include "driven_nodes.hpp"

#include <algorithm>

#include "bough/plan/small_inverse.hpp"
#include "system_parts.hpp"

namespace bough::step {

namespace {

constexpr double least_pivot = 1e-9;  ///< relative to the largest, rows of size 1: below, digits of the motion are lost

}  // namespace

DrivenNodes::DrivenNodes(const System& system, HeldNodes& trims)
    : num_free_(system.tree().num_unknowns()),
      n_(system.plan().unknowns.count),
      num_driven_(system.plan().driven.size()),
      place_(system.plan().directory.size(), -1) {
  const plan::Plan& plan = system.plan();
  std::size_t values = 0;
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    const std::size_t first = unknowns_.size();
    bool is_driven = false;
    for_each_part(plan, e, system.joint_of_element(static_cast<int>(e)), [&](int block, int size, int) {
      for (int i = 0; i < size; ++i) unknowns_.push_back(block < 0 ? -1 : system.block_begin(block) + i);
      is_driven |= block >= plan.graph.num_blocks();
    });
    if (!is_driven) {
      unknowns_.resize(first);
      continue;
    }
    const std::size_t size = unknowns_.size() - first;
    place_[e] = static_cast<int>(kept_.size());
    Kept k{e, static_cast<int>(size), first, values, {}};
    for (int kind = of_free; kind < num_kinds; ++kind) {
      k.local[kind] = local_.size();
      for (std::size_t i = 0; i < size; ++i)
        if (unknowns_[first + i] >= 0 && kind_of(unknowns_[first + i]) == kind) local_.push_back(static_cast<int>(i));
    }
    k.local[num_kinds] = local_.size();
    kept_.push_back(k);
    values += size * size;
  }
  values_.assign(values, 0.0);
  for (const Kept& k : kept_) trims.keep_whole(k.element, values_.data() + k.values);
  inverse_rows_.assign(num_driven_ * static_cast<std::size_t>(n_ * n_), 0.0);
  inverse_columns_ = inverse_rows_;
  rest_.assign(static_cast<std::size_t>(num_free_), 0.0);
}

DrivenNodes::Kind DrivenNodes::kind_of(std::int64_t unknown) const {
  if (unknown < num_free_) return of_free;
  return (unknown - num_free_) % (2 * n_) < n_ ? of_motion : of_row;
}

double DrivenNodes::product(const Kept& k, int row, Kind first, Kind last, const double* x) const {
  const double* a = values_.data() + k.values + static_cast<std::size_t>(row * k.size);
  const std::int64_t* unknowns = unknowns_.data() + k.unknowns;
  double sum = 0.0;
  for (int j : local(k, first, last)) sum += a[j] * x[unknowns[j]];
  return sum;
}

void DrivenNodes::symmetrise(std::size_t element) {
  const Kept& k = kept(element);
  double* a = values_.data() + k.values;
  for (int i = 1; i < k.size; ++i)
    for (int j = 0; j < i; ++j) a[i * k.size + j] = a[j * k.size + i] = 0.5 * (a[i * k.size + j] + a[j * k.size + i]);
}

std::optional<std::size_t> DrivenNodes::factor() {
  std::fill(inverse_rows_.begin(), inverse_rows_.end(), 0.0);
  std::fill(inverse_columns_.begin(), inverse_columns_.end(), 0.0);
  for (const Kept& k : kept_) {
    const std::int64_t* unknowns = unknowns_.data() + k.unknowns;
    const double* a = values_.data() + k.values;
    for (int i : local(k, of_row, of_row)) {
      const std::int64_t driven = (unknowns[i] - num_free_) / (2 * n_),
                         first = first_of(static_cast<std::size_t>(driven));
      for (int j : local(k, of_motion, of_motion)) {  // its own node's: joints that move a node lead to no other
        const std::int64_t r = unknowns[i] - first - n_, c = unknowns[j] - first, at = driven * n_ * n_;
        inverse_rows_[static_cast<std::size_t>(at + r * n_ + c)] += a[i * k.size + j];
        inverse_columns_[static_cast<std::size_t>(at + c * n_ + r)] += a[j * k.size + i];
      }
    }
  }
  for (std::size_t d = 0; d < num_driven_; ++d)
    for (std::vector<double>* list : {&inverse_rows_, &inverse_columns_})
      if (!plan::invert_small(list->data() + static_cast<std::int64_t>(d) * n_ * n_, static_cast<int>(n_), least_pivot))
        return d;
  return std::nullopt;
}

const double* DrivenNodes::reduce(const double* rhs, double* x) {
  std::copy(rhs, rhs + num_free_, rest_.begin());
  bool moves = false;
  for (std::size_t d = 0; d < num_driven_; ++d) {
    const double* inverse = inverse_rows_.data() + static_cast<std::int64_t>(d) * n_ * n_;
    const std::int64_t first = first_of(d);
    for (std::int64_t i = 0; i < n_; ++i) {
      double sum = 0.0;
      for (std::int64_t r = 0; r < n_; ++r) sum += inverse[i * n_ + r] * rhs[first + n_ + r];
      x[first + i] = sum;
      moves |= sum != 0.0;
    }
  }
  if (!moves) return rest_.data();
  for (const Kept& k : kept_)
    for (int i : local(k, of_free, of_free))
      rest_[static_cast<std::size_t>(unknowns_of(k)[static_cast<std::size_t>(i)])] -=
          product(k, i, of_motion, of_motion, x);
  return rest_.data();
}

void DrivenNodes::complete(const double* rhs, double* x) const {
  for (std::size_t d = 0; d < num_driven_; ++d) {
    const std::int64_t first = first_of(d);
    std::copy(rhs + first, rhs + first + n_, x + first + n_);
  }
  for (const Kept& k : kept_)
    for (int i : local(k, of_motion, of_motion))
      x[unknowns_of(k)[static_cast<std::size_t>(i)] + n_] -= product(k, i, of_free, of_motion, x);
  for (std::size_t d = 0; d < num_driven_; ++d) {
    const double* inverse = inverse_columns_.data() + static_cast<std::int64_t>(d) * n_ * n_;
    double* multipliers = x + first_of(d) + n_;
    double forces[6];
    std::copy(multipliers, multipliers + n_, forces);
    for (std::int64_t i = 0; i < n_; ++i) {
      multipliers[i] = 0.0;
      for (std::int64_t c = 0; c < n_; ++c) multipliers[i] += inverse[i * n_ + c] * forces[c];
    }
  }
}

void DrivenNodes::add_product(const double* x, double* y) const {
  std::fill(y + num_free_, y + first_of(num_driven_), 0.0);
  for (const Kept& k : kept_)
    for (int kind = of_free; kind < num_kinds; ++kind)
      for (int i : local(k, static_cast<Kind>(kind), static_cast<Kind>(kind)))
        y[unknowns_of(k)[static_cast<std::size_t>(i)]] +=
            product(k, i, kind == of_free ? of_motion : of_free, of_row, x);
}

}  // namespace bough::step
