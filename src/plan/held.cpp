/// Nodes that joints hold at rest: what is known of them beforehand needs no unknowns.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "bough/elements/rows.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using motion::Vec6;

namespace {

constexpr double closed = 1e-13;      ///< relative gap of a joint that a consistent start leaves as well
constexpr double least_pivot = 1e-6;  ///< relative to the largest, rows of size 1: below, the rows hold the node hardly

bool is_to_ground(const elements::Joint& e) {
  return e.ports[0].node == elements::ground || e.ports[1].node == elements::ground;
}

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 6, 6>;

/// Inverse, row-major; none where rows nearly depend on each other.
std::optional<std::vector<double>> invert(Matrix a) {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> scale = a.rowwise().lpNorm<Eigen::Infinity>();
  if (!(scale.minCoeff() > 0.0)) return std::nullopt;
  scale = scale.cwiseInverse();
  Eigen::FullPivLU<Matrix> lu(scale.asDiagonal() * a);
  lu.setThreshold(least_pivot);
  if (!lu.isInvertible()) return std::nullopt;
  a = lu.inverse() * scale.asDiagonal();
  return std::vector<double>(a.data(), a.data() + a.size());
}

/// Looks at one node after the other.
class Holder {
 public:
  explicit Holder(const Builder& b)
      : b_(b), plan_(b.plan), laws_(b.plan.laws.size(), 0.0), joints_at_(b.plan.nodes.size()) {
    for (std::size_t i = 0; i < laws_.size(); ++i)
      if (law(static_cast<int>(i)).is_constant()) laws_[i] = law(static_cast<int>(i)).at(0.0).value;
    for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
      if (plan_.joints[j].rows.empty()) continue;
      for (const Port& p : joint_of(plan_, plan_.joints[j]).ports)
        if (p.node != elements::ground) joints_at_[static_cast<std::size_t>(p.node)].push_back(static_cast<int>(j));
    }
  }

  /// Joints between a node and the ground, where they have enough rows to hold it; else none.
  std::vector<int> joints_that_hold(std::size_t node) const {
    std::vector<int> list;
    int rows = 0;
    for (int j : joints_at_[node])
      if (is_to_ground(joint(j))) {
        list.push_back(j);
        rows += num_rows(j);
      }
    if (rows < plan_.unknowns.count) list.clear();
    return list;
  }

  /// Fills `held`, or says what stands against it.
  std::optional<std::string> try_to_hold(std::size_t node, const std::vector<int>& joints, HeldNode& held) const {
    int rows = 0;
    for (int j : joints) {
      const elements::Joint& e = joint(j);
      for (const Port& p : e.ports)
        if (p.carrier >= 0) return "the frame it is fixed to moves";
      for (int row : plan_.joints[static_cast<std::size_t>(j)].rows)
        if (e.rows[row].law >= 0 && !law(e.rows[row].law).is_constant()) return "a law moves it";
      if (e.num_efforts > 0) return "a joint that holds it has springs or drives of its own";
      rows += num_rows(j);
    }
    if (rows > plan_.unknowns.count) return "it is held more than once";
    if (const char* way = loop_from(node, joints)) return way;
    const Vec6<double>& twist = plan_.nodes[node].twist;
    if (plan_.is_dynamic && lanes::dot(twist, twist) > 0.0) return "it starts moving";
    held.node = static_cast<int>(node);
    held.joints = joints;
    return set_inverse(held);
  }

 private:
  const elements::Joint& joint(int j) const { return joint_of(plan_, plan_.joints[static_cast<std::size_t>(j)]); }
  const laws::Law& law(int i) const { return plan_.laws[static_cast<std::size_t>(i)].law; }
  int num_rows(int j) const { return static_cast<int>(plan_.joints[static_cast<std::size_t>(j)].rows.size()); }

  /// Over joints other than those that hold the node. Where these lead to the ground or form a loop, rows may depend on each other, and how their
  /// multipliers share a load, by least norm in scales that the node's unknowns take part in, is a matter of all of them. In a tree that is held at this node
  /// alone no combination of rows is without force.
  const char* loop_from(std::size_t node, const std::vector<int>& holding) const {
    std::vector<std::size_t> front{node};
    std::vector<bool> seen(plan_.nodes.size(), false);
    seen[node] = true;
    std::size_t ends = 0;  // two of each joint
    for (std::size_t k = 0; k < front.size(); ++k)
      for (int j : joints_at_[front[k]]) {
        if (std::find(holding.begin(), holding.end(), j) != holding.end()) continue;
        if (is_to_ground(joint(j)))
          return "another chain of joints leads from it to the ground: their rows may depend on each other";
        ++ends;
        for (const Port& p : joint(j).ports)
          if (const auto next = static_cast<std::size_t>(p.node); !seen[next]) {
            seen[next] = true;
            front.push_back(next);
          }
      }
    return ends / 2 + 1 == front.size() ? nullptr
                                        : "joints that it carries form a loop: their rows may depend on each other";
  }

  /// W: by column the wrench on the node of one multiplier of size 1, in the unknowns of the node. It stays as the node does.
  std::optional<std::string> set_inverse(HeldNode& held) const {
    const int n = plan_.unknowns.count;
    Matrix W(n, n);
    int column = 0;
    for (int j : held.joints) {
      const elements::Joint& e = joint(j);
      elements::PortMotion<double> p[2];
      for (int k = 0; k < 2; ++k) p[k] = {b_.initial_pose(e.ports[k]), Vec6<double>::zero(), Vec6<double>::zero()};
      const elements::Surroundings<double> around{motion::Vec3<double>::zero(), laws_.data(), false};
      const int side = e.ports[0].node == held.node ? 0 : 1;
      for (int row : plan_.joints[static_cast<std::size_t>(j)].rows) {
        double unit[elements::max_rows] = {}, out[12 + elements::max_rows];
        unit[row] = 1.0;
        elements::eval_residual(e, p, unit, around, out, 0.0);
        if (!(std::abs(out[12 + row]) <= closed * (elements::is_length(e.rows[row].kind) ? plan_.length_scale : 1.0)))
          return "it does not start where it is held";
        Vec6<double> wrench;
        for (int i = 0; i < 6; ++i) wrench[i] = out[6 * side + i];
        if (e.ports[side].has_offset) wrench = motion::inverse_adjoint_transpose_times(e.ports[side].offset, wrench);
        double part[6];
        plan_.unknowns.project(wrench, static_cast<std::size_t>(held.node), part);
        for (int i = 0; i < n; ++i) W(i, column) = part[i];
        ++column;
      }
    }
    const auto inverse = invert(W);
    if (!inverse) return "its joints do not hold it on all sides";
    held.inverse = *inverse;
    return std::nullopt;
  }

  const Builder& b_;
  const Plan& plan_;
  std::vector<double> laws_;                 ///< values of those that are constant
  std::vector<std::vector<int>> joints_at_;  ///< by node, those with rows
};

}  // namespace

void Builder::hold_nodes() {
  const Holder holder(*this);
  std::vector<HeldNode> held;
  std::string obstacle;
  std::size_t against = 0;
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const std::vector<int> joints = holder.joints_that_hold(n);
    if (joints.empty()) continue;
    HeldNode candidate;
    const auto o = holder.try_to_hold(n, joints, candidate);
    if (!o)
      held.push_back(candidate);
    else if (against++ == 0)
      obstacle = "'" + plan.nodes[n].name + "': " + *o;
  }
  const std::string rows = std::to_string(held.size() * static_cast<std::size_t>(plan.unknowns.count));
  std::string reason = "no joint holds a node to the ground on all sides";
  bool holds = !held.empty();
  if (holds) {
    reason = "'" + plan.nodes[static_cast<std::size_t>(held.front().node)].name + "'" +
             (held.size() == 1 ? " does" : " and " + std::to_string(held.size() - 1) + " more do") +
             " not move: " + rows + " unknowns and " + rows + " rows of joints are left out";
    if (against > 0) reason += "; not " + obstacle;
  } else if (against > 0) {
    reason = obstacle;
  }
  if (holds && held.size() == plan.nodes.size()) {
    holds = false;
    reason = "nothing would be left";
  }
  decide("held",
         "nodes that the ground holds at rest have no unknowns, and the joints that hold them no multipliers in the "
         "system: these follow from the forces on the node. Taken where joints and constant displacements leave a node "
         "no motion, "
         "and other joints neither lead from it to the ground nor form a loop",
         holds, reason);
  if (plan.took("held")) plan.held = std::move(held);
}

}  // namespace bough::plan
