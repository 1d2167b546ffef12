#pragma once
/// What a profile needs of plan and tree besides times. Internal to study.
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/plan/plan.hpp"
#include "bough/records/profile.hpp"
#include "bough/tree/tree.hpp"

namespace bough::study {

/// By sub-domain: entries that the assembled matrix has (dense blocks) in the rows and columns eliminated there, less
/// those eliminated before.
std::vector<std::int64_t> count_matrix_entries(const blocks::BlockGraph& graph, const tree::Tree& tree);

/// Elements of the structure as it is given, with their leaves, and the nodes that stand in separators.
void draw_parts(const plan::Plan& plan, const tree::Tree& tree, records::Profile& out);

}  // namespace bough::study
