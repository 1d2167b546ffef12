#include "trimmed_elements.hpp"

#include "element_parts.hpp"

namespace bough::step {

TrimmedElements::TrimmedElements(const plan::Plan& plan) : kind_(plan.directory.size(), Kind::whole) {
  for (const plan::HeldNode& held : plan.held)
    for (const int j : held.joints)
      kind_[static_cast<std::size_t>(plan.joints[static_cast<std::size_t>(j)].element)] = Kind::holds;
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    int unknown = 0;
    std::vector<std::int8_t> kept;
    for_each_part(plan, e, [&](int block, int size, int node) {
      const int own = num_kept(plan, block, size, node);
      for (int i = 0; i < own; ++i) kept.push_back(static_cast<std::int8_t>(unknown + i));
      if (node >= 0 && own < size && kind_[e] != Kind::holds) kind_[e] = Kind::trimmed;
      unknown += size;
    });
    if (kind_[e] == Kind::trimmed) kept_.insert(kept_.end(), kept.begin(), kept.end());
    begin_.push_back(static_cast<std::int64_t>(kept_.size()));
  }
}

}  // namespace bough::step
