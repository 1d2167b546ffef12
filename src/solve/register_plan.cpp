#include "register_plan.hpp"

#include <algorithm>

namespace bough::solve {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

class RegisterPlanner {
 public:
  RegisterPlanner(const blocks::BlockGraph& graph, const tree::Tree& tree, const LanePlan& lanes, bool is_symmetric)
      : graph_(graph), tree_(tree), lanes_(lanes), is_symmetric_(is_symmetric) {}

  RegisterPlan run() {
    plan_.front_of.assign(at(tree_.num_fronts()), -1);
    plan_.groups.resize(lanes_.groups.size());
    for (std::size_t g = 0; g < lanes_.groups.size(); ++g) {
      if (!lanes_.groups[g].in_registers) continue;
      const tree::Subdomain& s = tree_.subdomains[at(lanes_.groups[g].subdomains.front())];
      RegisterGroup& group = plan_.groups[g];
      group.front_begin = static_cast<int>(plan_.fronts.size());
      for (tree::FrontId f = s.front_begin; f < s.front_end; ++f)
        if (f + 1 < tree_.num_fronts()) add_front(f, static_cast<int>(g));
      group.front_end = static_cast<int>(plan_.fronts.size());
      place_schur(group);
    }
    return std::move(plan_);
  }

 private:
  const tree::Front& front(tree::FrontId f) const { return tree_.fronts[at(f)]; }
  int size_of_block(int b) const { return graph_.block_size[at(b)]; }

  void add_front(tree::FrontId id, int group) {
    const tree::Front& own = front(id);
    RegisterFront f;
    f.front = id;
    f.group = group;
    f.eliminated = own.num_eliminated;
    f.boundary = own.num_boundary;
    plan_.front_of[at(id)] = static_cast<int>(plan_.fronts.size());
    f.is_exported = own.parent == tree::none || own.parent + 1 == tree_.num_fronts() ||
                    front(own.parent).subdomain != own.subdomain;
    add_unknowns(own, f);
    add_children(own, f);
    add_moves(own, f);
    f.factor = plan_.factor_size;
    plan_.factor_size += (f.factor_size(is_symmetric_) + row_register - 1) / row_register * row_register;
    f.vector = plan_.vector_size;
    plan_.vector_size += f.eliminated;
    plan_.fronts.push_back(f);
  }

  void add_unknowns(const tree::Front& own, RegisterFront& f) {
    int row = 0;
    const auto add = [&](std::int64_t begin, std::int64_t end) {
      const std::size_t first = plan_.unknown_runs.size();
      for (auto k = begin; k < end; ++k) {
        const int b = tree_.front_blocks[at(k)], unknown = static_cast<int>(tree_.unknown_begin[at(b)]);
        if (plan_.unknown_runs.size() > first &&
            plan_.unknown_runs.back().unknown + plan_.unknown_runs.back().length == unknown)
          plan_.unknown_runs.back().length += size_of_block(b);
        else
          plan_.unknown_runs.push_back({unknown, row, size_of_block(b)});
        row += size_of_block(b);
      }
    };
    f.own_begin = static_cast<int>(plan_.unknown_runs.size());
    add(own.block_begin, own.block_begin + own.num_eliminated_blocks);
    f.own_end = f.boundary_begin = static_cast<int>(plan_.unknown_runs.size());
    add(own.block_begin + own.num_eliminated_blocks, own.block_end);
    f.boundary_end = static_cast<int>(plan_.unknown_runs.size());
  }

  void add_children(const tree::Front& own, RegisterFront& f) {
    f.child_begin = static_cast<int>(plan_.children.size());
    for (tree::FrontId c : tree_.children(own)) {
      RegisterChild child{.front = plan_.front_of[at(c)]};
      child.run_begin = static_cast<std::int32_t>(plan_.runs.size());
      const tree::Front& from = front(c);
      int row = 0;
      for (auto k = from.block_begin + from.num_eliminated_blocks; k < from.block_end; ++k) {
        const int to = tree_.parent_row[at(k)], length = size_of_block(tree_.front_blocks[at(k)]);
        if (static_cast<std::int32_t>(plan_.runs.size()) > child.run_begin &&
            plan_.runs.back().to + plan_.runs.back().length == to)
          plan_.runs.back().length += length;
        else
          plan_.runs.push_back({row, to, length});
        row += length;
      }
      child.run_end = static_cast<std::int32_t>(plan_.runs.size());
      plan_.children.push_back(child);
    }
    f.child_end = static_cast<int>(plan_.children.size());
  }

  /// Blocks of a source: rows and columns in the same order, as runs that are adjacent there and in the front.
  void add_source(const std::vector<LaneRun>& runs, RegisterFront& f, int child, std::int64_t source, int step) {
    for (const LaneRun& rows : runs)
      for (const LaneRun& columns : runs)
        for (int i = 0, count = 0; i < rows.length; i += count)
          for (int r = columns.to / row_register, width = 0; r * row_register < columns.to + columns.length;
               r += width) {
            // Registers of rows are written first or added to; a move ends where this changes.
            const auto is_reached = [&](int k, int q) { return reached_[at((rows.to + k) * f.registers() + q)]; };
            RegisterMove move;
            move.is_first = !is_reached(i, r);
            if (r == columns.to / row_register)
              for (count = 1; i + count < rows.length && alike(rows.to + i, rows.to + i + count, columns, f); ++count) {
              }
            for (width = 0;
                 (r + width) * row_register < columns.to + columns.length && is_reached(i, r + width) != move.is_first;
                 ++width) {
              for (int l = 0; l < row_register; ++l) {
                const int j = (r + width) * row_register + l;
                if (j >= columns.to && j < columns.to + columns.length)
                  move.mask[width] = static_cast<std::uint8_t>(move.mask[width] | 1u << l);
              }
              for (int k = i; k < i + count; ++k) newly_.push_back((rows.to + k) * f.registers() + r + width);
            }
            move.source = static_cast<std::int32_t>(source + static_cast<std::int64_t>(rows.from + i) * step +
                                                    columns.from + r * row_register - columns.to);
            move.target = (rows.to + i) * f.step() + r * row_register;
            move.rows = static_cast<std::int8_t>(count);
            move.row_step = static_cast<std::int16_t>(step);
            move.registers = static_cast<std::int8_t>(width);
            move.child = child;
            plan_.moves.push_back(move);
            for (const int k : newly_) reached_[at(k)] = true;
            newly_.clear();
          }
  }

  /// The condensed right-hand side of a child: the last lane of its rows to that of the front's rows.
  void add_condensed(const std::vector<LaneRun>& runs, const RegisterFront& f, int child, int step) {
    const int last = f.registers() - 1;
    for (const LaneRun& run : runs)
      for (int i = 0, count = 0; i < run.length; i += count) {
        const auto is_reached = [&](int k) { return reached_[at((run.to + k) * f.registers() + last)]; };
        RegisterMove move;
        move.is_first = !is_reached(i);
        for (count = 1; i + count < run.length && is_reached(i + count) != move.is_first; ++count) {
        }
        for (int k = i; k < i + count; ++k) reached_[at((run.to + k) * f.registers() + last)] = true;
        move.mask[0] = 1u << (row_register - 1);
        move.source = (run.from + i) * step + step - row_register;
        move.target = (run.to + i) * f.step() + last * row_register;
        move.rows = static_cast<std::int8_t>(count);
        move.row_step = static_cast<std::int16_t>(step);
        move.child = child;
        plan_.moves.push_back(move);
      }
  }

  /// Whether the same registers of two rows were written before, in some columns.
  bool alike(int a, int b, const LaneRun& columns, const RegisterFront& f) const {
    for (int r = columns.to / row_register; r * row_register < columns.to + columns.length; ++r)
      if (reached_[at(a * f.registers() + r)] != reached_[at(b * f.registers() + r)]) return false;
    return true;
  }

  void add_moves(const tree::Front& own, RegisterFront& f) {
    f.move_begin = static_cast<int>(plan_.moves.size());
    f.gap_begin = static_cast<int>(plan_.gaps.size());
    reached_.assign(at(f.size() * f.registers()), false);
    f.values =
        own.element_begin < own.element_end ? lanes_.element_first[at(tree_.element_order[at(own.element_begin)])] : 0;
    std::vector<LaneRun> runs;
    for (int p = own.element_begin; p < own.element_end; ++p) {
      const int e = tree_.element_order[at(p)];
      runs.clear();
      int size = 0;
      for (auto k = graph_.element_begin[at(e)]; k < graph_.element_begin[at(e) + 1]; ++k) {
        const int to = tree_.scatter[at(tree_.scatter_begin[at(p)] + k - graph_.element_begin[at(e)])];
        const int length = size_of_block(graph_.element_blocks[at(k)]);
        if (!runs.empty() && runs.back().to + runs.back().length == to)
          runs.back().length += length;
        else
          runs.push_back({size, to, length});
        size += length;
      }
      add_source(runs, f, -1, lanes_.element_first[at(e)] - f.values, size);
      f.num_values = lanes_.element_first[at(e)] - f.values + static_cast<std::int64_t>(size) * size;
    }
    for (int c = f.child_begin; c < f.child_end; ++c) {
      const RegisterChild& child = plan_.children[at(c)];
      const std::vector<LaneRun> of_child(plan_.runs.begin() + child.run_begin, plan_.runs.begin() + child.run_end);
      const int step = plan_.fronts[at(child.front)].schur_step();
      add_source(of_child, f, c - f.child_begin, 0, step);
      add_condensed(of_child, f, c - f.child_begin, step);
    }
    for (int i = 0; i < f.size(); ++i)
      for (int r = 0; r < f.registers(); ++r)
        if (!reached_[at(i * f.registers() + r)]) plan_.gaps.push_back(i * f.step() + r * row_register);
    f.move_end = static_cast<int>(plan_.moves.size());
    f.gap_end = static_cast<int>(plan_.gaps.size());
    share_moves(f);
  }

  /// Fronts with equal lists share them, so that the lists stay in the nearest cache.
  void share_moves(RegisterFront& f) {
    constexpr std::size_t remembered = 32;
    for (const Lists& known : lists_) {
      if (!std::equal(plan_.moves.begin() + f.move_begin, plan_.moves.begin() + f.move_end,
                      plan_.moves.begin() + known.move_begin, plan_.moves.begin() + known.move_end) ||
          !std::equal(plan_.gaps.begin() + f.gap_begin, plan_.gaps.begin() + f.gap_end,
                      plan_.gaps.begin() + known.gap_begin, plan_.gaps.begin() + known.gap_end))
        continue;
      plan_.moves.resize(at(f.move_begin));
      plan_.gaps.resize(at(f.gap_begin));
      f.move_begin = known.move_begin;
      f.move_end = known.move_end;
      f.gap_begin = known.gap_begin;
      f.gap_end = known.gap_end;
      return;
    }
    if (lists_.size() == remembered) lists_.erase(lists_.begin());
    lists_.push_back({f.move_begin, f.move_end, f.gap_begin, f.gap_end});
  }

  /// Places the rows that a front passes up by first fit; they are needed until its parent has read them.
  void place_schur(RegisterGroup& group) {
    struct Live {
      std::int64_t begin, end;
      int last;
    };
    std::vector<Live> live;  // by begin
    std::int64_t most = 0;
    for (int i = group.front_begin; i < group.front_end; ++i) {
      RegisterFront& f = plan_.fronts[at(i)];
      const int reader = f.is_exported ? i : reader_of(f);
      std::erase_if(live, [&](const Live& x) { return x.last < i; });
      std::int64_t place = 0;
      auto it = live.begin();
      for (; it != live.end() && it->begin < place + f.schur_size(); ++it) place = it->end;
      live.insert(it, {place, place + f.schur_size(), reader});
      most = std::max(most, place + f.schur_size());
      f.schur = place;
    }
    group.schur = plan_.schur_size;
    plan_.schur_size += most;
  }

  int reader_of(const RegisterFront& f) const { return plan_.front_of[at(front(f.front).parent)]; }

  struct Lists {
    int move_begin, move_end, gap_begin, gap_end;
  };

  const blocks::BlockGraph& graph_;
  const tree::Tree& tree_;
  const LanePlan& lanes_;
  const bool is_symmetric_;
  std::vector<int> newly_;     ///< scratch
  std::vector<bool> reached_;  ///< by row and register of the present front
  std::vector<Lists> lists_;   ///< the last new lists
  RegisterPlan plan_;
};

}  // namespace

bool fits_registers(const tree::Tree& tree, tree::SubdomainId leaf) {
  const tree::Subdomain& s = tree.subdomains[at(leaf)];
  if (!s.is_leaf()) return false;
  int count = 0;
  for (tree::FrontId f = s.front_begin; f < s.front_end; ++f) {
    if (f + 1 == tree.num_fronts()) continue;
    if (tree.fronts[at(f)].size() > largest_in_registers) return false;
    ++count;
  }
  return count > 0;
}

RegisterPlan make_register_plan(const blocks::BlockGraph& graph, const tree::Tree& tree, const LanePlan& lanes,
                                bool is_symmetric) {
  return RegisterPlanner(graph, tree, lanes, is_symmetric).run();
}

}  // namespace bough::solve
