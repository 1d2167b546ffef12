#include "bough/step/residual_sums.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "bough/lanes/pack.hpp"
#include "element_parts.hpp"
#include "node_size.hpp"
#include "trimmed_elements.hpp"

namespace bough::step {

namespace {

constexpr std::array<double, most_unknowns> no_magnitudes{};

/// The bits of sizes are ordered as the sizes are, with those of what is not finite above all others, and no trap
/// minds to compare them.
constexpr std::int64_t all_but_sign = 0x7fffffffffffffff, bits_of_infinity = 0x7ff0000000000000;
inline std::int64_t size_bits(double a) { return std::bit_cast<std::int64_t>(a) & all_but_sign; }

/// `Size` numbers that are added up, or looked at for the largest of each.
template <int Size>
struct Registers {
  static constexpr int wide = Size % 4 == 0 ? 4 : 2, count = Size / wide;
  using Pack = lanes::Pack<wide>;
  using Bits = typename lanes::Mask<wide>::Flag;
  Pack sum[count];
  Bits most[count][Pack::chunks] = {};

  void begin() {
    for (Pack& s : sum) s = Pack(0.0);
  }
  void add(const double* part) {
    for (int k = 0; k < count; ++k) sum[k] = sum[k] + Pack::load(part + k * wide);
  }
  double operator[](int i) const { return sum[i / wide][i % wide]; }
  void note_sizes() {
    for (int k = 0; k < count; ++k)
      for (int c = 0; c < Pack::chunks; ++c) {
        const Bits now = __builtin_bit_cast(Bits, sum[k].r[c]) & (Bits{} + all_but_sign);
        most[k][c] = now > most[k][c] ? now : most[k][c];
      }
  }
  std::array<std::int64_t, Size> largest() const { return __builtin_bit_cast(std::array<std::int64_t, Size>, most); }
};

}  // namespace

ResidualSums::ResidualSums(const plan::Plan& plan, const UnknownPlaces& places, const LinearSolution& linear,
                           const TrimmedElements* trimmed)
    : plan_(plan), places_(places), right_hand_side_(places.size(), 0.0), is_length_(places.size(), 0) {
  place_parts(linear, trimmed);
  for (const UnknownPlaces::Multiplier& m : places.multipliers()) is_length_[m.unknown] = m.is_of_length;
  chunk_sizes_.resize(chunks_.size(), {{}, true});
}

/// Divides the sums from `begin` on, first those of nodes, then of points, then of joints.
void ResidualSums::add_chunks(std::size_t begin, std::size_t nodes, std::size_t points) {
  const std::size_t nodes_end = begin + nodes, points_end = nodes_end + points;
  for (std::size_t end; begin < sums_.size(); begin = end) {
    end = std::min(begin + static_cast<std::size_t>(block_grain), sums_.size());
    chunks_.push_back({begin, std::clamp(nodes_end, begin, end), std::clamp(points_end, begin, end), end});
  }
}

/// Where the parts of elements lie, and which of them add up to a block, or to the forces on a node that is held.
void ResidualSums::place_parts(const LinearSolution& linear, const TrimmedElements* trimmed) {
  const auto count = static_cast<std::size_t>(places_.num_blocks());
  std::vector<std::vector<std::int64_t>> uses(count + plan_.held.size());
  std::vector<std::size_t> held_of_node(plan_.nodes.size(), 0);
  for (std::size_t h = 0; h < plan_.held.size(); ++h) held_of_node[static_cast<std::size_t>(plan_.held[h].node)] = h;
  element_begin_.assign(1, 0);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    std::int64_t at = element_begin_.back();
    const bool counts = trimmed == nullptr || !trimmed->leaves_out(e);
    for_each_part(plan_, e, [&](int block, int size, int node) {
      if (block >= 0)
        uses[static_cast<std::size_t>(block)].push_back(2 * at);
      else if (counts && node >= 0)
        uses[count + held_of_node[static_cast<std::size_t>(node)]].push_back(2 * at);
      at += size;
    });
    element_begin_.push_back(at);
  }
  parts_.assign(static_cast<std::size_t>(2 * element_begin_.back()), 0.0);
  const auto add = [&](const std::vector<std::int64_t>& list, std::int64_t unknown, int size, int owner) {
    const auto begin = static_cast<std::int64_t>(uses_.size());
    uses_.insert(uses_.end(), list.begin(), list.end());
    sums_.push_back({begin, static_cast<std::int64_t>(uses_.size()), unknown, size, owner});
  };
  const BlockOwners& owners = linear.owners();
  std::vector<std::vector<int>> blocks(static_cast<std::size_t>(linear.visits().count()));
  for (int b = 0; b < places_.num_blocks(); ++b)
    blocks[static_cast<std::size_t>(linear.visits().of_block[static_cast<std::size_t>(b)])].push_back(b);
  std::vector<int> of_chunk;
  for (std::size_t v = 0; v < blocks.size(); ++v) {
    const std::size_t first = sums_.size();
    const auto add_nodes = [&](bool points) {
      const std::size_t before = sums_.size();
      for (const int b : blocks[v])
        if (owners.node(b) >= 0 && plan_.unknowns.is_point_at(static_cast<std::size_t>(owners.node(b))) == points)
          add(uses[static_cast<std::size_t>(b)], places_.block_begin(b), places_.block_size(b), owners.node(b));
      return sums_.size() - before;
    };
    const std::size_t nodes = add_nodes(false), points = add_nodes(true);
    for (const int b : blocks[v])
      if (owners.joint(b) >= 0)
        add(uses[static_cast<std::size_t>(b)], places_.block_begin(b), places_.block_size(b), owners.joint(b));
    add_chunks(first, nodes, points);
    of_chunk.resize(chunks_.size(), static_cast<int>(v));
  }
  chunks_by_visit_ = VisitRanges(of_chunk, linear.visits().count());
  const std::size_t first_held = sums_.size();
  for (std::size_t h = 0; h < plan_.held.size(); ++h)
    add(uses[count + h], -1, plan_.unknowns.count, plan_.held[h].node);
  add_chunks(first_held, 0, 0);
}

void ResidualSums::set_parts(std::size_t element, const double* residual, const double* magnitude) {
  const plan::JointPlan* const joint = plan_.joint_of(element);
  const auto size = static_cast<int>(element_begin_[element + 1] - element_begin_[element]);
  const int rows = (joint == nullptr ? 0 : static_cast<int>(joint->rows.size())) +
                   static_cast<int>(plan::signals_of(plan_, element).size());
  if (magnitude == nullptr) magnitude = no_magnitudes.data();
  join_parts(plan_.unknowns.count, size, rows, residual, magnitude, parts_.data() + 2 * element_begin_[element]);
}

/// Adds up parts of nodes that have unknowns, in a fixed order.
template <int Count>
ResidualSums::ChunkSize ResidualSums::sum_nodes(std::size_t begin, std::size_t end) {
  Registers<2 * Count> sums;
  for (std::size_t k = begin; k < end; ++k) {
    const Sum& to = sums_[k];
    sums.begin();
    for (std::int64_t use = to.use_begin; use < to.use_end; ++use)
      sums.add(parts_.data() + uses_[static_cast<std::size_t>(use)]);
    sums.note_sizes();
    double* const b = right_hand_side_.data() + to.unknown;
    for (int i = 0; i < Count; ++i) b[i] = -sums[i];
  }
  const std::array<std::int64_t, 2 * Count> most = sums.largest();
  double sum_of[6] = {}, terms_of[6] = {};
  ChunkSize chunk{{}, true};
  for (int i = 0; i < Count; ++i) {
    const auto sum = static_cast<std::size_t>(i), terms = static_cast<std::size_t>(Count + i);
    chunk.is_finite &= most[sum] < bits_of_infinity;
    sum_of[i] = std::bit_cast<double>(most[sum]);
    terms_of[i] = std::bit_cast<double>(most[terms]);
  }
  if (!chunk.is_finite) return chunk;
  const NodeSize left = size_up(plan_.unknowns.motions, sum_of), terms = size_up(plan_.unknowns.motions, terms_of);
  chunk.size.force = left.force;
  chunk.size.moment = left.moment;
  chunk.size.force_scale = terms.force;
  chunk.size.moment_scale = terms.moment;
  return chunk;
}

/// Rows are those of one joint each: nothing is added up.
void ResidualSums::copy_rows(std::size_t begin, std::size_t end, ChunkSize& chunk) {
  std::int64_t most[2] = {0, 0};  // of angles, of lengths
  for (std::size_t k = begin; k < end; ++k) {
    const Sum& to = sums_[k];
    const double* const from = parts_.data() + uses_[static_cast<std::size_t>(to.use_begin)];
    double* const b = right_hand_side_.data() + to.unknown;
    const char* const is_length = is_length_.data() + to.unknown;
    for (int i = 0; i < to.size; ++i) {
      b[i] = -from[i];
      std::int64_t& size = most[static_cast<std::size_t>(is_length[i])];
      size = std::max(size, size_bits(b[i]));
    }
  }
  chunk.is_finite &= std::max(most[0], most[1]) < bits_of_infinity;
  chunk.size.angle = std::bit_cast<double>(most[0]);
  chunk.size.length = std::bit_cast<double>(most[1]);
}

/// Sums of forces at a node, then of their magnitudes, with all components that elements have at it.
std::array<double, 12> ResidualSums::add_up(const Sum& sum) const {
  std::array<double, 12> total{};
  const int numbers = 2 * plan_.unknowns.count;
  for (std::int64_t use = sum.use_begin; use < sum.use_end; ++use)
    for (int i = 0; i < numbers; ++i)
      total[static_cast<std::size_t>(i)] += parts_[static_cast<std::size_t>(uses_[static_cast<std::size_t>(use)] + i)];
  return total;
}

/// Forces on a point, whose moments are zero and belong to no unknown.
void ResidualSums::sum_point(const Sum& sum, ChunkSize& chunk) {
  const std::array<double, 12> total = add_up(sum);
  const auto count = static_cast<std::size_t>(plan_.unknowns.count);
  double* const b = right_hand_side_.data() + sum.unknown;
  for (std::size_t i = 0; i < static_cast<std::size_t>(sum.size); ++i) {
    b[i] = -total[i];
    chunk.is_finite &= size_bits(b[i]) < bits_of_infinity;
    chunk.size.force = std::max(chunk.size.force, std::abs(b[i]));
    chunk.size.force_scale = std::max(chunk.size.force_scale, total[count + i]);
  }
}

/// Forces on a node that is held: balanced by the joints that hold it, they only tell how large forces are.
void ResidualSums::sum_held_node(const Sum& sum, ChunkSize& chunk) const {
  const std::array<double, 12> total = add_up(sum);
  for (int i = 0; i < sum.size; ++i)
    chunk.is_finite &= size_bits(total[static_cast<std::size_t>(i)]) < bits_of_infinity;
  const NodeSize held_by = size_up(plan_.unknowns.motions, total.data()),
                 terms = size_up(plan_.unknowns.motions, total.data() + sum.size);
  chunk.size.force_scale = std::max(chunk.size.force_scale, terms.force + held_by.force);
  chunk.size.moment_scale = std::max(chunk.size.moment_scale, terms.moment + held_by.moment);
}

void ResidualSums::sum_chunk(std::size_t index) {
  const Chunk& c = chunks_[index];
  const int count = plan_.unknowns.count;
  ChunkSize size = count == 6   ? sum_nodes<6>(c.begin, c.nodes_end)
                   : count == 3 ? sum_nodes<3>(c.begin, c.nodes_end)
                                : sum_nodes<1>(c.begin, c.nodes_end);
  for (std::size_t k = c.nodes_end; k < c.points_end; ++k) sum_point(sums_[k], size);
  copy_rows(c.points_end, c.end, size);
  chunk_sizes_[index] = size;
}

void ResidualSums::sum_visit(int visit, const tree::Walker& walker) {
  chunks_by_visit_.for_each(walker, visit, 1, [this](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) sum_chunk(static_cast<std::size_t>(c));
  });
}

void ResidualSums::sum_held() {
  for (auto c = static_cast<std::size_t>(chunks_by_visit_.count()); c < chunks_.size(); ++c) {
    chunk_sizes_[c] = {{}, true};
    for (std::size_t k = chunks_[c].begin; k < chunks_[c].end; ++k) sum_held_node(sums_[k], chunk_sizes_[c]);
  }
}

ResidualSize ResidualSums::size() const {
  ResidualSize s;
  for (const ChunkSize& chunk : chunk_sizes_) {
    const ResidualSize& c = chunk.size;
    s.force = std::max(s.force, c.force);
    s.moment = std::max(s.moment, c.moment);
    s.force_scale = std::max(s.force_scale, c.force_scale);
    s.moment_scale = std::max(s.moment_scale, c.moment_scale);
    s.length = std::max(s.length, c.length);
    s.angle = std::max(s.angle, c.angle);
  }
  s.signal = signal_share_;
  s.worst_signal = worst_signal_;
  return s;
}

void ResidualSums::clear_signals() {
  signal_share_ = 0.0;
  worst_signal_ = lost_signal_ = -1;
}

void ResidualSums::set_signal(int signal, std::size_t unknown, double residual, double size_of_terms) {
  right_hand_side_[unknown] = -residual;
  if (!std::isfinite(residual)) lost_signal_ = signal;
  const double share = residual == 0.0 ? 0.0 : std::abs(residual) / size_of_terms;
  if (!(share > signal_share_)) return;
  signal_share_ = share;
  worst_signal_ = signal;
}

void ResidualSums::name_worst(ResidualSize& size) const {
  ResidualSize most;
  for (std::int64_t c = 0; c < chunks_by_visit_.count(); ++c) {
    const Chunk& chunk = chunks_[static_cast<std::size_t>(c)];
    for (std::size_t k = chunk.begin; k < chunk.points_end; ++k) {
      const Sum& sum = sums_[k];
      const NodeSize now =
          size_up(plan_.unknowns, static_cast<std::size_t>(sum.owner), right_hand_side_.data() + sum.unknown);
      if (now.force > most.force) size.worst_force_node = sum.owner;
      if (now.moment > most.moment) size.worst_moment_node = sum.owner;
      most.force = std::max(most.force, now.force);
      most.moment = std::max(most.moment, now.moment);
    }
    for (std::size_t k = chunk.points_end; k < chunk.end; ++k)
      for (int i = 0; i < sums_[k].size; ++i) {
        const double violation = std::abs(right_hand_side_[static_cast<std::size_t>(sums_[k].unknown + i)]);
        if (violation <= most.length) continue;
        most.length = violation;
        size.worst_joint = sums_[k].owner;
      }
  }
}

bool ResidualSums::is_finite() const {
  return lost_signal_ < 0 &&
         std::all_of(chunk_sizes_.begin(), chunk_sizes_.end(), [](const ChunkSize& c) { return c.is_finite; });
}

std::optional<std::size_t> ResidualSums::first_not_finite() const {
  for (std::size_t e = 0; e < plan_.directory.size(); ++e)
    for (std::int64_t i = 2 * element_begin_[e]; i < 2 * element_begin_[e + 1]; ++i)
      if (!std::isfinite(parts_[static_cast<std::size_t>(i)])) return e;
  return std::nullopt;
}

}  // namespace bough::step
