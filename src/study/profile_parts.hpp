#pragma once
/// Data of a profile that come from the plan and the tree instead of measurements. Internal to study.
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/plan/plan.hpp"
#include "bough/records/profile.hpp"
#include "bough/tree/tree.hpp"

namespace bough::study {

/// For each sub-domain the number of entries of the assembled matrix (dense blocks) in the rows and columns eliminated
/// there, without those eliminated before.
std::vector<std::int64_t> count_matrix_entries(const blocks::BlockGraph& graph, const tree::Tree& tree);

/// The elements of the structure in its initial shape, with their leaves, and the nodes in separators.
void draw_parts(const plan::Plan& plan, const tree::Tree& tree, records::Profile& out);

}  // namespace bough::study
