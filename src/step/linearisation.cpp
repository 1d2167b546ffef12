#include "bough/step/linearisation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/blocks/at.hpp"

namespace bough::step {

namespace {

/// Slope at which C or M is evaluated [1/s, 1/s^2], a power of two: K is then below the last digit of the product, and
/// what is left of it is subtracted.
constexpr double steep = 0x1p60;

/// A fixed vector without zeros.
std::vector<double> vector_without_zeros(std::size_t size) {
  std::vector<double> y(size);
  for (std::size_t i = 0; i < size; ++i) y[i] = 1.5 + std::sin(static_cast<double>(7 * i + 1));
  return y;
}

}  // namespace

Linearisation::Linearisation(System& system) : system_(system) {
  const plan::Plan& plan = system.plan();
  const blocks::BlockGraph& g = plan.graph;
  const UnknownPlaces& places = system.places();
  is_row_.assign(places.size(), 0);
  weights_.assign(places.size(), 0.0);
  for (int b = 0; b < g.num_blocks(); ++b) {
    const bool is_row = g.block_kind[at(b)] == blocks::BlockKind::multiplier;
    if (is_row) num_rows_ += g.block_size[at(b)];
    const bool is_signal = system.linear().owners().signal(b) >= 0;
    for (int i = 0; i < g.block_size[at(b)]; ++i) {
      const std::size_t unknown = at(places.block_begin(b) + i);
      is_row_[unknown] = is_row ? 1 : 0;
      const bool is_length = !is_signal && !is_row && plan.unknowns.is_length(i);
      weights_[unknown] = is_row ? 0.0 : is_length ? 1.0 / (plan.length_scale * plan.length_scale) : 1.0;
    }
  }
  unknown_begin_.push_back(0);
  matrix_begin_.push_back(0);
  for (int e = 0; e < g.num_elements(); ++e) {
    for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k) {
      const int b = g.element_blocks[at(k)];
      for (int i = 0; i < g.block_size[at(b)]; ++i) unknowns_.push_back(places.block_begin(b) + i);
    }
    unknown_begin_.push_back(static_cast<std::int64_t>(unknowns_.size()));
    const std::int64_t n = unknown_begin_.back() - unknown_begin_[at(e)];
    matrix_begin_.push_back(matrix_begin_.back() + n * n);
  }
}

std::span<const std::int64_t> Linearisation::unknowns_of(int element) const {
  const std::size_t begin = at(unknown_begin_[at(element)]), end = at(unknown_begin_[at(element) + 1]);
  return {unknowns_.data() + begin, end - begin};
}

/// to = tangents, or what they have beside K at a steep slope, without the round-off of K.
void Linearisation::copy_tangents(Vector& to, bool beside_stiffness) const {
  constexpr double round_off = 64.0 * std::numeric_limits<double>::epsilon();
  to.resize(at(matrix_begin_.back()));
  const solve::AnySolver& solver = system_.linear().solver();
  for (int e = 0; e < num_elements(); ++e) {
    const solve::ConstElementView from = solver.element(e);
    const std::size_t begin = at(matrix_begin_[at(e)]), count = at(matrix_begin_[at(e) + 1]) - begin;
    double most = 0.0;
    for (std::size_t k = 0; k < count && beside_stiffness; ++k) most = std::max(most, std::abs(parts_[0][begin + k]));
    for (std::size_t k = 0; k < count; ++k) {
      const double value = from[static_cast<std::int64_t>(k)];
      const double beside = beside_stiffness ? value - parts_[0][begin + k] : value;
      to[begin + k] = !beside_stiffness ? value : std::abs(beside) > round_off * most ? beside / steep : 0.0;
    }
  }
}

void Linearisation::take_tangents() {
  copy_tangents(parts_[0], false);
  parts_[1].clear();
  parts_[2].clear();
}

std::optional<Trouble> Linearisation::take(const State& state) {
  State at_rest_of_step = state;  // slopes are those of increments from here: dq = 0
  at_rest_of_step.change_all([](auto& nodes) {
    for (auto& node : nodes.motion) node.dq = std::decay_t<decltype(node.dq)>::zero();
  });
  LinearSolution& linear = system_.linear();
  const bool took_symmetric_parts = linear.takes_symmetric_parts();
  linear.take_symmetric_parts(false);
  const elements::Slopes slopes[] = {{}, {.velocity = steep, .rate = steep}, {.acceleration = steep}};
  std::optional<Trouble> trouble;
  for (std::size_t k = 0; k < parts_.size() && !trouble; ++k) {
    trouble = system_.evaluate(at_rest_of_step, slopes[k], true);
    copy_tangents(parts_[k], k > 0);
  }
  linear.take_symmetric_parts(took_symmetric_parts);
  linear.forget_factor();
  return trouble;
}

std::span<const double> Linearisation::matrix_of(Part part, int element) const {
  const std::size_t begin = at(matrix_begin_[at(element)]), end = at(matrix_begin_[at(element) + 1]);
  return {of(part).data() + begin, end - begin};
}

void Linearisation::add_difference(Part to, double factor, const Linearisation& other) {
  Vector& difference = parts_[static_cast<std::size_t>(to)];
  difference.resize(parts_[0].size(), 0.0);
  for (int e = 0; e < num_elements(); ++e) {
    const std::span<const std::int64_t> unknowns = unknowns_of(e);
    const std::size_t n = unknowns.size(), begin = at(matrix_begin_[at(e)]);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n && is_row_[at(unknowns[i])] == 0; ++j)
        if (const std::size_t k = begin + i * n + j; is_row_[at(unknowns[j])] == 0)
          difference[k] += factor * (parts_[0][k] - other.parts_[0][k]);
  }
}

/// (A + sign A^T) / 2 of one element
void Linearisation::mix_with_transpose(Part part, int element, double sign) {
  const std::size_t n = size_of(element);
  double* const a = parts_[static_cast<std::size_t>(part)].data() + matrix_begin_[at(element)];
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double half = 0.5 * (a[i * n + j] + sign * a[j * n + i]);
      a[i * n + j] = half;
      a[j * n + i] = sign * half;
    }
}

void Linearisation::take_symmetric_part(Part part) {
  for (int e = 0; e < num_elements(); ++e) mix_with_transpose(part, e, 1.0);
}

void Linearisation::leave_out_dampers() {
  const plan::Plan& plan = system_.plan();
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      if (elements::dissipates(e)) mix_with_transpose(Part::damping, static_cast<int>(id), -1.0);
    });
}

void Linearisation::leave_out_signals() {
  std::vector<char> is_signal(size(), 0);
  for (const std::size_t unknown : system_.places().signals()) is_signal[unknown] = 1;
  for (int e = 0; e < num_elements(); ++e) {
    const std::span<const std::int64_t> unknowns = unknowns_of(e);
    const std::size_t n = unknowns.size(), begin = at(matrix_begin_[at(e)]);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (i != j && (is_signal[at(unknowns[i])] != 0 || is_signal[at(unknowns[j])] != 0))
          for (Vector& part : parts_)
            if (!part.empty()) part[begin + i * n + j] = 0.0;
  }
}

/// to += factor of ad(v), by element and node
void Linearisation::add_product(Part to, double factor, Part of_part, const State& state) {
  const plan::Plan& plan = system_.plan();
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(plan, state);
  const blocks::BlockGraph& g = plan.graph;
  for (int e = 0; e < num_elements(); ++e) {
    const std::size_t n = size_of(e);
    double* const sum = parts_[static_cast<std::size_t>(to)].data() + matrix_begin_[at(e)];
    const double* const a = of(of_part).data() + matrix_begin_[at(e)];
    std::size_t column = 0;
    for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k) {
      const int block = g.element_blocks[at(k)], node = system_.linear().owners().node(block);
      const auto count = static_cast<std::size_t>(g.block_size[at(block)]);
      for (std::size_t j = 0; j < count && node >= 0; ++j) {
        std::array<double, 6> unit{}, turned{};
        unit[j] = 1.0;
        const motion::Vec6<double> v = nodes[at(node)].v, x = plan.unknowns.expanded(unit.data(), at(node));
        const auto u_v = lanes::linear_part(v), w_v = lanes::angular_part(v), u = lanes::linear_part(x),
                   w = lanes::angular_part(x);
        const motion::Vec3<double> linear = lanes::cross(w_v, u) + lanes::cross(u_v, w);
        plan.unknowns.project(lanes::join(linear, lanes::cross(w_v, w)), at(node), turned.data());
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t l = 0; l < count; ++l) sum[i * n + column + j] += factor * a[i * n + column + l] * turned[l];
      }
      column += count;
    }
  }
}

void Linearisation::describe_from_ground(const State& state) { add_product(Part::damping, -1.0, Part::mass, state); }

void Linearisation::describe_from_parts(const State& state) {
  add_product(Part::stiffness, 1.0, Part::damping, state);
  add_product(Part::damping, 1.0, Part::mass, state);
}

double Linearisation::inner(std::span<const double> x, std::span<const double> y) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) sum += weights_[i] * x[i] * y[i];
  return sum;
}

int Linearisation::largest_node(std::span<const double> x) const {
  const plan::Plan& plan = system_.plan();
  int found = -1;
  double largest = 0.0;
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const std::int64_t begin = system_.places().node_begin(static_cast<int>(n));
    double size = 0.0;
    for (int i = 0; i < (begin < 0 ? 0 : plan.unknowns.count_of(n)); ++i)
      size += weights_[at(begin + i)] * x[at(begin + i)] * x[at(begin + i)];
    if (!(size > largest)) continue;
    largest = size;
    found = static_cast<int>(n);
  }
  return found;
}

/// y_i = sum of entry(a_ij, i, j) over all elements; entry(value, row, column, mirror): also told the mirror image.
template <class Entry>
void Linearisation::multiply_entries(Part part, std::span<double> y, Entry&& entry) const {
  std::fill(y.begin(), y.end(), 0.0);
  for (int e = 0; e < num_elements(); ++e) {
    const std::span<const std::int64_t> unknowns = unknowns_of(e);
    const std::size_t n = unknowns.size();
    const double* const a = of(part).data() + matrix_begin_[at(e)];
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < n; ++j) sum += entry(a[i * n + j], a[j * n + i], at(unknowns[j]));
      y[at(unknowns[i])] += sum;
    }
  }
}

void Linearisation::multiply(Part part, std::span<const double> x, std::span<double> y) const {
  multiply_entries(part, y, [x](double a, double, std::size_t j) { return a * x[j]; });
}

void Linearisation::multiply_magnitudes(Part part, std::span<const double> x, std::span<double> y) const {
  multiply_entries(part, y, [x](double a, double, std::size_t j) { return std::abs(a * x[j]); });
}

double Linearisation::asymmetry(Part part) const {
  const Vector y = vector_without_zeros(size());
  Vector difference(size()), magnitude(size());
  multiply_entries(part, difference, [&](double a, double t, std::size_t j) { return (a - t) * y[j]; });
  multiply_entries(part, magnitude,
                   [&](double a, double t, std::size_t j) { return (std::abs(a) + std::abs(t)) * y[j]; });
  double largest = 0.0;
  for (std::size_t i = 0; i < size(); ++i)
    if (magnitude[i] > 0.0) largest = std::max(largest, std::abs(difference[i]) / magnitude[i]);
  return largest;
}

double Linearisation::largest(Part part) const {
  double most = 0.0;
  for (const double a : of(part)) most = std::max(most, std::abs(a));
  return most;
}

double Linearisation::form(Part part, int element, std::span<const double> x, std::span<const double> y) const {
  const std::span<const std::int64_t> unknowns = unknowns_of(element);
  const std::size_t n = unknowns.size();
  const double* const a = of(part).data() + matrix_begin_[at(element)];
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n && is_row_[at(unknowns[i])] == 0; ++j)
      if (is_row_[at(unknowns[j])] == 0) sum += x[at(unknowns[i])] * a[i * n + j] * y[at(unknowns[j])];
  return sum;
}

double Linearisation::round_off(Part part, std::span<const double> x) const {
  constexpr double round_offs = 64.0;
  Vector motion(size()), sums(size());
  for (std::size_t i = 0; i < size(); ++i) motion[i] = is_row_[i] != 0 ? 0.0 : x[i];
  multiply_magnitudes(part, motion, sums);
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) sum += std::abs(motion[i]) * sums[i];
  return round_offs * std::numeric_limits<double>::epsilon() * sum;
}

/// Sums of |diagonal entries| over elements, by unknown.
Linearisation::Vector Linearisation::diagonal_of(Part part) const {
  Vector sums(size(), 0.0);
  for (int e = 0; e < num_elements(); ++e) {
    const std::span<const std::int64_t> unknowns = unknowns_of(e);
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      sums[at(unknowns[i])] += std::abs(of(part)[at(matrix_begin_[at(e)]) + i * (unknowns.size() + 1)]);
  }
  return sums;
}

double Linearisation::fastest() const {
  const Vector K = diagonal_of(Part::stiffness), M = diagonal_of(Part::mass);
  double most = 0.0;
  for (std::size_t i = 0; i < size(); ++i)
    if (M[i] > 0.0 && is_row_[i] == 0) most = std::max(most, K[i] / M[i]);
  return most;
}

void Linearisation::write(const Combination& of_parts, bool symmetric) {
  const Vector diagonal = of_parts.of_diagonal > 0.0 ? diagonal_of(Part::stiffness) : Vector();
  std::vector<char> has_diagonal(size(), 0);
  const double factors[] = {of_parts.stiffness, of_parts.damping, of_parts.mass};
  Vector sum;
  for (int e = 0; e < num_elements(); ++e) {
    const std::span<const std::int64_t> unknowns = unknowns_of(e);
    const std::size_t n = unknowns.size(), begin = at(matrix_begin_[at(e)]);
    sum.assign(n * n, 0.0);
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (std::size_t k = 0; k < n * n && factors[p] != 0.0; ++k) sum[k] += factors[p] * parts_[p][begin + k];
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t unknown = at(unknowns[i]);
      for (std::size_t j = 0; j < n; ++j)
        if (is_row_[unknown] != 0 || is_row_[at(unknowns[j])] != 0) sum[i * n + j] = parts_[0][begin + i * n + j];
      if (is_row_[unknown] != 0 || has_diagonal[unknown]++ != 0) continue;
      sum[i * (n + 1)] += of_parts.weights * weights_[unknown];
      if (!diagonal.empty()) sum[i * (n + 1)] += of_parts.of_diagonal * diagonal[unknown];
    }
    const solve::ElementView to = factored_->element(e);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        to[static_cast<std::int64_t>(i * n + j)] = symmetric ? 0.5 * (sum[i * n + j] + sum[j * n + i]) : sum[i * n + j];
  }
}

solve::FactorStatus Linearisation::factor(const Combination& of_parts, solve::Symmetry symmetry) {
  const plan::Plan& plan = system_.plan();
  if (!factored_ || symmetry != symmetry_)
    factored_ = std::make_unique<solve::Hierarchical>(plan.graph, system_.linear().tree(),
                                                      solve::SolveOptions{.symmetry = symmetry,
                                                                          .inertia = true,
                                                                          .lanes = plan.took("lanes"),
                                                                          .data_precision = plan.precision,
                                                                          .check = solve::SolveCheck::none});
  symmetry_ = symmetry;
  write(of_parts, symmetry == solve::Symmetry::symmetric);
  factored_->rescale();
  ++factorizations_;
  return factored_->factor(system_.walker());
}

bool Linearisation::factor_soundly(const Combination& of_parts, solve::Symmetry symmetry) {
  constexpr double allowed = 1e-9;
  if (!factor(of_parts, symmetry).ok()) return false;
  Vector known = vector_without_zeros(size()), forces(size()), found(size()), again(size());
  for (std::size_t i = 0; i < size(); ++i)
    if (weights_[i] > 0.0) known[i] /= std::sqrt(weights_[i]);
  factored_->multiply(system_.walker(), known.data(), forces.data());
  if (!solve(forces, found)) return false;
  factored_->multiply(system_.walker(), found.data(), again.data());
  double left[2] = {0.0, 0.0}, whole[2] = {0.0, 0.0};  // of forces, and of constraint rows
  for (std::size_t i = 0; i < size(); ++i) {
    const double weight = is_row_[i] != 0 ? 1.0 : 1.0 / weights_[i];
    const std::size_t kind = is_row_[i] != 0 ? 1 : 0;
    left[kind] += weight * (again[i] - forces[i]) * (again[i] - forces[i]);
    whole[kind] += weight * forces[i] * forces[i];
  }
  return left[0] <= allowed * allowed * whole[0] && left[1] <= allowed * allowed * whole[1];
}

bool Linearisation::solve(std::span<const double> rhs, std::span<double> x) {
  ++solutions_;
  static_cast<void>(factored_->solve(system_.walker(), rhs.data(), x.data()));
  return std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
}

int Linearisation::num_negative() {
  const int negative = factored_->inertia().negative;
  if (negative < 0) return -1;
  return negative - (num_rows_ - std::max(0, factored_->last_status().deficiency));
}

}  // namespace bough::step
