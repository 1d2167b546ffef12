#include "dependent_rows.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

namespace bough::run {

namespace {

constexpr std::size_t named_joints = 4, named_groups = 4;

/// "joint 'a'", "joints 'a' and 'b'", "joints 'a', 'b', 'c' and 7 others connected to them"
std::string group_text(const std::vector<std::string>& names) {
  const std::size_t shown = names.size() <= named_joints ? names.size() : named_joints - 1;
  std::string text = names.size() == 1 ? "joint" : "joints";
  for (std::size_t i = 0; i < shown; ++i)
    text += (i == 0 ? " '" : i + 1 == names.size() ? " and '" : ", '") + names[i] + "'";
  if (shown < names.size()) text += " and " + std::to_string(names.size() - shown) + " others of their loops";
  return text;
}

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

std::string dependent_groups_text(const step::System& system, std::span<const int> blocks) {
  const plan::Plan& plan = system.plan();
  std::vector<std::size_t> joints, parent(plan.nodes.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto first_node = [&plan](std::size_t j) {
    std::size_t node = plan.nodes.size();
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(plan.joints[j].element)],
                       [&](const auto& e) {
                         for (const elements::Port& p : e.ports)
                           if (p.node != elements::ground) node = static_cast<std::size_t>(p.node);
                       });
    return node;
  };
  for (const int block : blocks) {
    const int j = system.linear().owners().joint(block);
    if (j < 0) continue;
    joints.push_back(static_cast<std::size_t>(j));
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(plan.joints[joints.back()].element)],
                       [&](const auto& e) {
                         const std::size_t last = first_node(joints.back());
                         for (const elements::Port& p : e.ports)
                           if (p.node != elements::ground)
                             parent[root_of(parent, static_cast<std::size_t>(p.node))] = root_of(parent, last);
                       });
  }
  std::sort(joints.begin(), joints.end());  // as the scene lists them, whatever the order of elimination
  std::vector<std::vector<std::string>> groups;
  std::map<std::size_t, std::size_t> group_of;
  for (const std::size_t j : joints) {
    const auto [group, is_new] = group_of.try_emplace(root_of(parent, first_node(j)), groups.size());
    if (is_new) groups.emplace_back();
    groups[group->second].push_back(plan.joints[j].name);
  }
  std::string text;
  for (std::size_t g = 0; g < groups.size() && g < named_groups; ++g)
    text += (g == 0 ? "" : "; ") + group_text(groups[g]);
  if (groups.size() > named_groups) text += "; and " + std::to_string(groups.size() - named_groups) + " more groups";
  return text;
}

}  // namespace bough::run
