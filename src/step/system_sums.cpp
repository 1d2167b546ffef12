/// System: sums of the elements' parts by block and by held node, and how large they are.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "bough/step/system.hpp"
#include "held_nodes.hpp"
#include "system_parts.hpp"

namespace bough::step {

namespace {

/// By exponents, which no trap minds and compilers vectorise.
inline bool is_finite(double a) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000u;
  return (std::bit_cast<std::uint64_t>(a) & exponent) != exponent;
}

double largest_of_three(const double* a) { return std::max(std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2])); }

struct NodeSize {
  double force, moment;
};
/// Largest entries of the force and the moment at a node.
inline NodeSize size_up(plan::Motions motions, const double* a) {
  switch (motions) {
    case plan::Motions::spatial:
      return {largest_of_three(a), largest_of_three(a + 3)};
    case plan::Motions::planar:
      return {std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2])};
    case plan::Motions::translation:
      return {largest_of_three(a), 0.0};
    case plan::Motions::line:
      break;
  }
  return {std::abs(a[0]), 0.0};
}

/// r = sum of parts, m = sum of terms, of `Size` entries each; Size 0: of `size`. Returns whether r is finite.
template <int Size>
bool add_parts(const double* parts, const double* terms, const std::int64_t* begin, const std::int64_t* end, int size,
               double* to_r, double* to_m) {
  const int count = Size > 0 ? Size : size;
  double r[Size > 0 ? Size : most_unknowns], m[Size > 0 ? Size : most_unknowns];  // not memory that others might share
  for (int i = 0; i < count; ++i) r[i] = m[i] = 0.0;
  for (const std::int64_t* use = begin; use != end; ++use)
    for (int i = 0; i < count; ++i) {
      r[i] += parts[*use + i];
      m[i] += terms[*use + i];
    }
  bool finite = true;
  for (int i = 0; i < count; ++i) {
    to_r[i] = r[i];
    to_m[i] = m[i];
    finite &= is_finite(r[i]);
  }
  return finite;
}

}  // namespace

/// Where the parts of elements' residuals lie, and which of them add up to a block, or to the forces on a node that is held.
void System::place_parts() {
  const auto count = static_cast<std::size_t>(num_blocks());
  std::vector<std::vector<std::int64_t>> uses(count + plan_.held.size());
  std::vector<std::size_t> held_of_node(plan_.nodes.size(), 0);
  for (std::size_t h = 0; h < plan_.held.size(); ++h) held_of_node[static_cast<std::size_t>(plan_.held[h].node)] = h;
  element_begin_.assign(1, 0);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    std::int64_t at = element_begin_.back();
    const bool counts = !held_ || !held_->leaves_out(e);
    for_each_part(plan_, e, joint_of_element_[e], [&](int block, int size, int node) {
      if (block >= 0)
        uses[static_cast<std::size_t>(block)].push_back(at);
      else if (counts && node >= 0)
        uses[count + held_of_node[static_cast<std::size_t>(node)]].push_back(at);
      at += size;
    });
    element_begin_.push_back(at);
  }
  element_residual_.assign(static_cast<std::size_t>(element_begin_.back()), 0.0);
  element_magnitude_ = element_residual_;
  use_begin_.assign(1, 0);
  for (const auto& list : uses) {
    uses_.insert(uses_.end(), list.begin(), list.end());
    use_begin_.push_back(static_cast<std::int64_t>(uses_.size()));
  }
  node_of_block_.assign(count, -1);
  for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
    const int block = plan_.block_of_node[n];
    node_begin_.push_back(block < 0 ? -1 : block_begin(block));
    if (block >= 0) node_of_block_[static_cast<std::size_t>(block)] = static_cast<int>(n);
  }
}

/// Forces on a node that is held: balanced by the joints that hold it, they only tell how large forces are.
void System::sum_held_node(std::size_t held, ChunkSize& chunk) const {
  std::array<double, 6> r, m;
  const std::size_t use = static_cast<std::size_t>(num_blocks()) + held;
  chunk.is_finite &= add_parts<0>(element_residual_.data(), element_magnitude_.data(), uses_.data() + use_begin_[use],
                                  uses_.data() + use_begin_[use + 1], plan_.unknowns.count, r.data(), m.data());
  const NodeSize held_by = size_up(plan_.unknowns.motions, r.data()), terms = size_up(plan_.unknowns.motions, m.data());
  chunk.size.force_scale = std::max(chunk.size.force_scale, terms.force + held_by.force);
  chunk.size.moment_scale = std::max(chunk.size.moment_scale, terms.moment + held_by.moment);
}

/// Adds the parts of blocks [begin, end), a chunk, in a fixed order, and sizes up the sums. Nodes that are held come after the blocks.
void System::sum_blocks(std::int64_t begin, std::int64_t end) {
  ChunkSize chunk{{}, true};
  ResidualSize& s = chunk.size;
  for (std::int64_t b = begin; b < end; ++b) {
    const auto block = static_cast<std::size_t>(b);
    if (block >= joint_of_block_.size()) {
      sum_held_node(block - joint_of_block_.size(), chunk);
      continue;
    }
    const auto first = static_cast<std::size_t>(unknown_begin_[block]);
    const int size = static_cast<int>(unknown_begin_[block + 1] - unknown_begin_[block]);
    double *r = residual_.data() + first, *m = magnitude_.data() + first;
    const auto add = size == 6 ? add_parts<6> : size == 3 ? add_parts<3> : size == 2 ? add_parts<2> : add_parts<0>;
    if (!add(element_residual_.data(), element_magnitude_.data(), uses_.data() + use_begin_[block],
             uses_.data() + use_begin_[block + 1], size, r, m)) {
      chunk.is_finite = false;
      continue;
    }
    const int joint = joint_of_block_[block];
    if (joint < 0) {
      const NodeSize now = size_up(plan_.unknowns.motions, r), terms = size_up(plan_.unknowns.motions, m);
      if (now.force > s.force) s.worst_force_node = node_of_block_[block];
      if (now.moment > s.moment) s.worst_moment_node = node_of_block_[block];
      s.force = std::max(s.force, now.force);
      s.moment = std::max(s.moment, now.moment);
      s.force_scale = std::max(s.force_scale, terms.force);
      s.moment_scale = std::max(s.moment_scale, terms.moment);
      continue;
    }
    for (int i = 0; i < size; ++i) {
      const double value = std::abs(r[i]);
      if (value > std::max(s.length, s.angle)) s.worst_joint = joint;
      double& most = is_length_[first + static_cast<std::size_t>(i)] != 0 ? s.length : s.angle;
      most = std::max(most, value);
    }
  }
  chunk_sizes_[static_cast<std::size_t>(begin / block_grain)] = chunk;
}

ResidualSize System::residual_size() const {
  ResidualSize s;
  for (const ChunkSize& chunk : chunk_sizes_) {
    const ResidualSize& c = chunk.size;
    if (c.force > s.force) s.worst_force_node = c.worst_force_node;
    if (c.moment > s.moment) s.worst_moment_node = c.worst_moment_node;
    if (std::max(c.length, c.angle) > std::max(s.length, s.angle)) s.worst_joint = c.worst_joint;
    s.force = std::max(s.force, c.force);
    s.moment = std::max(s.moment, c.moment);
    s.force_scale = std::max(s.force_scale, c.force_scale);
    s.moment_scale = std::max(s.moment_scale, c.moment_scale);
    s.length = std::max(s.length, c.length);
    s.angle = std::max(s.angle, c.angle);
  }
  return s;
}

ResidualSize System::round_off_floor(const State&) const {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  std::vector<double>& floor = floor_;
  std::vector<std::int64_t>& unknowns = floor_unknowns_;
  floor.assign(num_unknowns(), 0.0);
  const auto count = static_cast<std::size_t>(plan_.unknowns.count);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    const solve::ConstElementView K = matrix_of(static_cast<int>(e), unknowns);
    const int j = joint_of_element_[e];
    const std::size_t n = unknowns.size(), rows = j < 0 || plan_.joints[static_cast<std::size_t>(j)].block < 0
                                                      ? 0
                                                      : plan_.joints[static_cast<std::size_t>(j)].rows.size();
    const std::size_t node_columns = n - rows;  // which come first
    for (std::size_t row = 0; row < n; ++row) {
      if (unknowns[row] < 0) continue;
      double sum = 0.0;
      for (std::size_t col = 0; col < node_columns; ++col)
        if (unknowns[col] >= 0)
          sum += std::abs(K[static_cast<std::int64_t>(row * n + col)]) *
                 (plan_.unknowns.is_length(static_cast<int>(col % count)) ? element_length_[e] : 1.0);
      floor[static_cast<std::size_t>(unknowns[row])] += eps * sum;
    }
  }
  ResidualSize s;
  for (int b = 0; b < num_blocks(); ++b) {
    if (joint_of_block_[static_cast<std::size_t>(b)] >= 0) continue;
    const NodeSize size = size_up(plan_.unknowns.motions, floor.data() + block_begin(b));
    s.force = std::max(s.force, size.force);
    s.moment = std::max(s.moment, size.moment);
  }
  s.length = 8.0 * eps * plan_.length_scale;
  s.angle = 8.0 * eps;
  return s;
}

}  // namespace bough::step
