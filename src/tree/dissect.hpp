#pragma once
/// Recursive dissection of the elements that have blocks. Internal to tree.
#include <string>
#include <vector>

#include "adjacency.hpp"
#include "bough/tree/tree.hpp"

namespace bough::tree {

/// A set of elements in the recursion. Parts come in postorder (children first), the root is last.
struct Part {
  int parent = -1;
  std::vector<int> children;
  std::vector<int> elements;  ///< of terminal parts only
  bool is_subdomain = false;  ///< on upper levels; the parts inside a leaf sub-domain are not sub-domains
  bool is_forest = false;     ///< for leaf sub-domains and parts below: the elements close no loop
  int level = 0;              ///< depth in the recursion
  bool is_terminal() const { return children.empty(); }
};

struct Dissection {
  std::vector<Part> parts;
  std::string method;
};

Dissection dissect(const Adjacency& adjacency, const TreeOptions& options);

}  // namespace bough::tree
