#include "bough/records/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bough::records {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

void add(SubdomainTimes& sum, const SubdomainTimes& t) {
  sum.evaluate += t.evaluate;
  sum.assemble += t.assemble;
  sum.factor += t.factor;
  sum.condense += t.condense;
  sum.forward += t.forward;
  sum.backward += t.backward;
  sum.move += t.move;
  sum.residual += t.residual;
  sum.wait = std::max(sum.wait, t.wait);
}

double largest_of(const std::vector<InterfaceNode>& nodes, const double (InterfaceNode::*part)[3]) {
  if (nodes.empty()) return std::numeric_limits<double>::quiet_NaN();
  double most = 0.0;
  for (const InterfaceNode& n : nodes) most = std::max(most, std::hypot((n.*part)[0], (n.*part)[1], (n.*part)[2]));
  return most;
}

}  // namespace

double SubdomainProfile::largest_force() const { return largest_of(nodes, &InterfaceNode::force); }
double SubdomainProfile::largest_moment() const { return largest_of(nodes, &InterfaceNode::moment); }

std::vector<LevelProfile> sum_levels(const std::vector<SubdomainProfile>& subdomains) {
  std::vector<LevelProfile> levels;
  for (const SubdomainProfile& s : subdomains) {
    if (static_cast<int>(levels.size()) <= s.level) levels.resize(at(s.level) + 1);
    LevelProfile& l = levels[at(s.level)];
    ++l.num_subdomains;
    l.num_unknowns += s.num_unknowns;
    l.interface_unknowns_most = std::max(l.interface_unknowns_most, s.interface_unknowns);
    l.fill += s.fill;
    l.flops += s.flops;
    l.bytes += s.bytes;
    add(l.times, s.times);
    if (!std::isnan(s.condition))
      l.condition_most = std::isnan(l.condition_most) ? s.condition : std::max(l.condition_most, s.condition);
  }
  for (std::size_t k = 0; k < levels.size(); ++k) levels[k].level = static_cast<int>(k);
  return levels;
}

void sum_subtrees(std::vector<SubdomainProfile>& subdomains) {
  for (SubdomainProfile& s : subdomains) s.subtree_seconds = s.times.solver();
  for (SubdomainProfile& s : subdomains)  // children come before their parents
    if (s.parent >= 0) subdomains[at(s.parent)].subtree_seconds += s.subtree_seconds;
}

}  // namespace bough::records
