#pragma once
/// A motion vector of each node, eight nodes in the lanes of a pack, as the passes over nodes compute with them.
#include <memory>
#include <vector>

#include "bough/elements/evaluate_lanes.hpp"
#include "bough/records/archive.hpp"
#include "bough/step/node_order.hpp"

namespace bough::step {

/// All vectors are zero until they get an order. Lanes behind the last node of an eight repeat it.
template <class G>
class NodeVectors {
 public:
  using Vector = typename G::template Vector<double>;
  using Lanes = typename G::template Vector<elements::LanePack>;

  /// Zero for all nodes of this order.
  void assign_zero(const std::shared_ptr<const NodeOrder>& order) {
    order_ = order;
    lanes_.assign(order->eights().size(), Lanes::zero());
  }
  /// Keeps the vectors and takes another order, if it is another one.
  void arrange(const std::shared_ptr<const NodeOrder>& order) {
    if (order_ == order) return;
    const NodeVectors before = *this;
    assign_zero(order);
    read_.clear();
    if (before.order_ == nullptr && before.read_.empty()) return;
    for (std::size_t n = 0; n < order->num_nodes(); ++n) set(n, before[n]);
  }
  void resize_as(const NodeVectors& like) {
    order_ = like.order_;
    lanes_.resize(like.lanes_.size());
    read_ = like.read_;
  }
  /// The vectors by node, which have no order once they are read.
  void checkpoint(records::Archive& archive) {
    std::vector<Vector> by_node = read_;
    for (std::size_t n = 0; order_ != nullptr && n < order_->num_nodes(); ++n) by_node.push_back((*this)[n]);
    archive(by_node);
    if (!archive.is_reading()) return;
    order_ = nullptr;
    lanes_.clear();
    read_ = std::move(by_node);
  }

  Vector operator[](std::size_t node) const {
    if (order_ == nullptr) return read_.empty() ? Vector::zero() : read_[node];
    const NodeOrder::Place at = order_->place(node);
    return lanes::get_lane(lanes_[at.eight], at.lane);
  }
  void set(std::size_t node, const Vector& v) {
    const NodeOrder::Place at = order_->place(node);
    for (int l = at.lane; l < at.lane + at.copies; ++l)
      for (int i = 0; i < G::dof; ++i) lanes_[at.eight][i].set(l, v[i]);
  }
  /// The vectors of NodeOrder::eights()[k].
  Lanes& eight(std::size_t k) { return lanes_[k]; }
  const Lanes& eight(std::size_t k) const { return lanes_[k]; }

 private:
  std::shared_ptr<const NodeOrder> order_;
  std::vector<Lanes> lanes_;
  std::vector<Vector> read_;  ///< by node, of vectors that were read from an archive and have no order yet
};

}  // namespace bough::step
