#include "lane_plan.hpp"

#include <algorithm>

#include "bough/solve/front_cost.hpp"
#include "lane_planner.hpp"

namespace bough::solve {

namespace {

/// Largest front in lanes: eight of them must stay in the second cache.
constexpr int largest_in_lanes = 64;
/// A single sub-domain uses the kernel of eight only if its fronts are so small that their overhead dominates.
constexpr int largest_alone = 24;
/// Sub-domains share a group while the common fronts cost at most this much more than those of the larger one.
constexpr double most_padding = 1.35;
constexpr double most_inner_padding = 3.0;
/// Solutions that a factor serves where lanes are judged, of which the solver does not know. Fixed steps of rod_chain
/// and of the crane's jib reuse one for 16 and 67 (`steps` of their summaries).
constexpr double solutions_of_a_factor = 12.0;
/// Time of a pack in a solution besides its bytes [s]. It is set to the value with which the crane's jib and the rotor
/// of data/ take no lanes that cost them time; the model of whole steps fits with 2e-8 (step_cost.cpp).
constexpr double per_pack_solved = 2e-7;

}  // namespace

LanePlan LanePlanner::run() {
  plan_.lane_front.assign(at(tree_.num_fronts()), -1);
  plan_.lane.assign(at(tree_.num_fronts()), 0);
  plan_.group_of_subdomain.assign(at(tree_.num_subdomains()), -1);
  plan_.element_first.assign(at(graph_.num_elements()), 0);
  plan_.element_stride.assign(at(graph_.num_elements()), 1);
  measure_subdomains();
  const int root = form({tree_.root()}, false);
  plan_.walk.subdomains[at(root)].parent = tree::none;
  set_levels();
  plan_.lists = moves_.take();
  return std::move(plan_);
}

void LanePlanner::measure_subdomains() {
  largest_.assign(at(tree_.num_subdomains()), 0);
  is_path_.assign(at(tree_.num_subdomains()), 0);
  for (tree::SubdomainId s = 0; s < tree_.num_subdomains(); ++s) {
    bool is_path = true;
    for (tree::FrontId f = subdomain(s).front_begin; f < subdomain(s).front_end; ++f) {
      largest_[at(s)] = std::max(largest_[at(s)], front(f).size());
      if (f + 1 < subdomain(s).front_end) is_path = is_path && front(f).parent == f + 1;
    }
    is_path_[at(s)] = is_path;
    for (tree::SubdomainId c : tree_.children(subdomain(s)))
      largest_[at(s)] = std::max(largest_[at(s)], largest_[at(c)]);
  }
}

tree::FrontId LanePlanner::front_at(tree::SubdomainId s, int k, int count) const {
  const int i = k - (count - count_of(s));
  return i < 0 ? tree::none : subdomain(s).front_begin + i;
}

std::optional<LanePlanner::Match> LanePlanner::match(tree::SubdomainId a, tree::SubdomainId b) const {
  if (tree_.children(subdomain(a)).size() != tree_.children(subdomain(b)).size()) return std::nullopt;
  const int na = count_of(a), nb = count_of(b), count = std::max(na, nb);
  if (na != nb && !(is_path_[at(a)] && is_path_[at(b)] && subdomain(a).is_leaf())) return std::nullopt;
  Match m{0.0, 0.0, 0.0};
  for (int k = 0; k < count; ++k) {
    const tree::FrontId fa = front_at(a, k, count), fb = front_at(b, k, count);
    int e = 0, bd = 0;
    if (fa != tree::none) {
      e = front(fa).num_eliminated;
      bd = front(fa).num_boundary;
      m.a += cost_of(e, bd);
    }
    if (fb != tree::none) {
      e = std::max(e, front(fb).num_eliminated);
      bd = std::max(bd, front(fb).num_boundary);
      m.b += cost_of(front(fb).num_eliminated, front(fb).num_boundary);
    }
    m.common += cost_of(e, bd);
    if (na == nb && k + 1 < count &&
        front(fa).parent - subdomain(a).front_begin != front(fb).parent - subdomain(b).front_begin)
      return std::nullopt;
  }
  return m;
}

bool LanePlanner::fits(tree::SubdomainId a, tree::SubdomainId b) const {
  const auto m = match(a, b);
  // Inner sub-domains are one front each: a poor fit there costs less than separating all sub-domains below.
  return m && m->common <= (subdomain(a).is_leaf() ? most_padding : most_inner_padding) * std::max(m->a, m->b);
}

/// The last pack of a class may have unused lanes. They take another class, such as the single leaf at the end of a
/// chain, if the pack grows by less than a separate one would cost.
void LanePlanner::fill_packs(Classes& classes) const {
  for (std::size_t b = 0; b < classes.size();) {
    const auto takes = [&](const std::vector<tree::SubdomainId>& members) {
      const std::size_t spare = (lanes_wide - members.size() % lanes_wide) % lanes_wide;
      if (&members == &classes[b] || classes[b].size() > spare || largest_[at(members.front())] > largest_in_lanes)
        return false;
      return std::all_of(classes[b].begin(), classes[b].end(), [&](tree::SubdomainId s) {
        const auto m = match(members.front(), s);
        return largest_[at(s)] <= largest_in_lanes && m && m->common <= m->a + m->b;
      });
    };
    const auto host = std::find_if(classes.begin(), classes.end(), takes);
    if (host == classes.end()) {
      ++b;
      continue;
    }
    host->insert(host->end(), classes[b].begin(), classes[b].end());
    classes.erase(classes.begin() + static_cast<std::ptrdiff_t>(b));
    b = 0;
  }
}

int LanePlanner::form(std::vector<tree::SubdomainId> subdomains, bool below_lanes) {
  const tree::SubdomainId first = subdomains.front();
  const bool in_lanes =
      use_lanes_ && first != tree_.root() &&
      (below_lanes || subdomains.size() > 1 || (largest_[at(first)] <= largest_alone && gain_of_lanes({first}) > 0.0));
  std::vector<int> children;
  for (std::vector<tree::SubdomainId>& group : group_children(subdomains)) {
    if (in_lanes || group.size() == 1 || gain_of_lanes(group) > 0.0) {
      children.push_back(form(std::move(group), in_lanes));
    } else {
      for (tree::SubdomainId s : group) children.push_back(form({s}, in_lanes));
    }
  }
  return close(std::move(subdomains), in_lanes, children);
}

LanePlanner::Classes LanePlanner::group_children(const std::vector<tree::SubdomainId>& subdomains) const {
  Classes classes, groups;
  const std::size_t num_children = tree_.children(subdomain(subdomains.front())).size();
  for (std::size_t c = 0; c < num_children; ++c)
    for (tree::SubdomainId s : subdomains) place_child(tree_.children(subdomain(s))[c], classes);
  if (use_lanes_) fill_packs(classes);
  for (const auto& members : classes)
    for (std::size_t i = 0, end = 0; i < members.size(); i = end) {
      end = std::min(members.size(), i + lanes_wide);
      groups.emplace_back(members.begin() + static_cast<std::ptrdiff_t>(i),
                          members.begin() + static_cast<std::ptrdiff_t>(end));
    }
  return groups;
}

/// A pack takes the same time however many of its lanes are used: two or three fronts of 30 unknowns are eliminated
/// faster one by one, and the factor of a pack with unused lanes takes more memory to read in every solution. The times
/// are those of general fronts: a solver that finds its matrix not to be symmetric keeps its groups.
double LanePlanner::gain_of_lanes(const std::vector<tree::SubdomainId>& subdomains) const {
  const auto bytes_of = [](int e, int b) { return sizeof(double) * static_cast<double>(e) * (e + 2.0 * b); };
  const auto time_of_pack = [&](int e, int b) {
    return front_cost::per_pack + front_cost::per_flop_of_pack * tree::elimination_flops(e, b) +
           solutions_of_a_factor * (per_pack_solved + front_cost::per_byte_solved * lanes_wide * bytes_of(e, b));
  };
  const auto time_alone = [&](int e, int b) {
    return e * (front_cost::per_column + front_cost::per_panel * (e + b)) +
           front_cost::per_flop * tree::elimination_flops(e, b) +
           solutions_of_a_factor * (front_cost::per_front_solved + front_cost::per_byte_solved * bytes_of(e, b));
  };
  double gain = 0.0;
  int count = 0;
  for (tree::SubdomainId s : subdomains) count = std::max(count, count_of(s));
  for (int k = 0; k < count; ++k) {
    int eliminated = 0, boundary = 0;
    for (tree::SubdomainId s : subdomains) {
      const tree::FrontId id = front_at(s, k, count);
      if (id == tree::none) continue;
      gain += time_alone(front(id).num_eliminated, front(id).num_boundary);
      eliminated = std::max(eliminated, front(id).num_eliminated);
      boundary = std::max(boundary, front(id).num_boundary);
    }
    gain -= time_of_pack(eliminated, boundary);
  }
  for (const std::vector<tree::SubdomainId>& group : group_children(subdomains)) gain += gain_of_lanes(group);
  return gain;
}

void LanePlanner::place_child(tree::SubdomainId s, Classes& classes) const {
  if (use_lanes_ && largest_[at(s)] <= largest_in_lanes)
    for (auto& members : classes)
      if (largest_[at(members.front())] <= largest_in_lanes && fits(members.front(), s)) {
        members.push_back(s);
        return;
      }
  classes.push_back({s});
}

int LanePlanner::close(std::vector<tree::SubdomainId> subdomains, bool in_lanes, const std::vector<int>& children) {
  const int id = static_cast<int>(plan_.groups.size());
  LaneGroup group;
  group.in_lanes = in_lanes;
  group.front_begin = static_cast<int>(plan_.fronts.size());
  group.element_begin = static_cast<int>(plan_.batches.size());
  for (tree::SubdomainId s : subdomains) plan_.group_of_subdomain[at(s)] = id;
  group.subdomains = std::move(subdomains);
  tree::Subdomain node;
  if (in_lanes) {
    add_fronts(group, node);
  } else {
    const tree::Subdomain& own = subdomain(group.subdomains.front());
    for (tree::FrontId f = own.front_begin; f < own.front_end; ++f)
      for (int e : tree_.elements(front(f))) {
        ElementBatch batch{.element = {}, .values = plan_.num_values, .stride = 1};
        batch.element.fill(-1);
        batch.element[0] = e;
        add_batch(batch, size_of(e));
      }
    node.flops = own.flops;
  }
  group.front_end = static_cast<int>(plan_.fronts.size());
  group.element_end = static_cast<int>(plan_.batches.size());
  node.subtree_flops = node.flops;
  node.subtree_begin = id;
  node.child_begin = static_cast<std::int32_t>(plan_.walk.subdomain_children.size());
  for (int c : children) {
    tree::Subdomain& child = plan_.walk.subdomains[at(c)];
    child.parent = id;
    node.subtree_flops += child.subtree_flops;
    node.subtree_begin = std::min(node.subtree_begin, child.subtree_begin);
    plan_.walk.subdomain_children.push_back(c);
  }
  node.child_end = static_cast<std::int32_t>(plan_.walk.subdomain_children.size());
  plan_.walk.subdomains.push_back(node);
  plan_.groups.push_back(std::move(group));
  return id;
}

void LanePlanner::set_levels() {
  for (auto s = plan_.walk.subdomains.rbegin(); s != plan_.walk.subdomains.rend(); ++s)
    s->level = s->parent == tree::none ? 0 : plan_.walk.subdomains[at(s->parent)].level + 1;
}

LanePlan make_lane_plan(const blocks::BlockGraph& graph, const tree::Tree& tree, bool use_lanes, Symmetry symmetry) {
  return LanePlanner(graph, tree, use_lanes, symmetry).run();
}

}  // namespace bough::solve
