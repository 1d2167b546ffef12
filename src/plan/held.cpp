/// Nodes that joints hold at rest: their motion is known, so they need no unknowns.
#include <algorithm>
#include <cmath>
#include <optional>

#include "bough/elements/rows.hpp"
#include "bough/plan/sets.hpp"
#include "bough/plan/small_inverse.hpp"
#include "geometry.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using motion::Vec6;

namespace {

constexpr double least_pivot = 1e-6;  ///< relative to the largest, with rows of size 1: below this, the rows hardly
                                      ///< determine the node

bool is_to_ground(const elements::Joint& e) {
  return e.ports[0].node == elements::ground || e.ports[1].node == elements::ground;
}

/// Examines the nodes one after the other.
class Holder {
 public:
  explicit Holder(const Builder& b)
      : b_(b),
        plan_(b.plan),
        laws_(b.plan.laws.size(), 0.0),
        joints_at_(b.plan.nodes.size()),
        group_of_(b.plan.nodes.size()),
        groups_(b.plan.nodes.size()) {
    for (std::size_t i = 0; i < laws_.size(); ++i)
      if (law(static_cast<int>(i)).is_constant()) laws_[i] = law(static_cast<int>(i)).at(0.0).value;
    for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
      if (plan_.joints[j].rows.empty()) continue;
      for (const Port& p : joint_of(plan_, plan_.joints[j]).ports)
        if (p.node != elements::ground) joints_at_[static_cast<std::size_t>(p.node)].push_back(static_cast<int>(j));
    }
    count_groups();
  }

  /// Joints between a node and the ground, if they have enough rows to hold it; otherwise none.
  std::vector<int> joints_that_hold(std::size_t node) const {
    std::vector<int> list;
    int rows = 0;
    for (int j : joints_at_[node])
      if (is_to_ground(joint(j))) {
        list.push_back(j);
        rows += num_rows(j);
      }
    if (rows < plan_.unknowns.count_of(node)) list.clear();
    return list;
  }

  /// Fills `held`, or returns the reason why the node cannot be held.
  std::optional<std::string> try_to_hold(std::size_t node, const std::vector<int>& joints, HeldNode& held) const {
    if (const char* way = mover_among(joints)) return way;
    if (const char* way = dependence_of(node, joints)) return way;
    if (starts_moving(node)) return "it starts moving";
    if (!are_closed(joints)) return "it does not start where it is held";
    held = {static_cast<int>(node), joints, wrenches(node, joints)};
    if (!invert_small(held.inverse.data(), plan_.unknowns.count_of(node), least_pivot))
      return "its joints do not hold it on all sides";
    return std::nullopt;
  }

 private:
  const elements::Joint& joint(int j) const { return joint_of(plan_, plan_.joints[static_cast<std::size_t>(j)]); }
  const laws::Law& law(int i) const { return plan_.laws[static_cast<std::size_t>(i)].law; }
  int num_rows(int j) const { return static_cast<int>(plan_.joints[static_cast<std::size_t>(j)].rows.size()); }

  /// What moves a node held by these joints, or adds forces: a moving frame, a law, an effort; null: nothing.
  const char* mover_among(const std::vector<int>& joints) const {
    for (int j : joints) {
      const elements::Joint& e = joint(j);
      for (const Port& p : e.ports)
        if (p.carrier >= 0) return "the frame it is fixed to moves";
      for (int row : plan_.joints[static_cast<std::size_t>(j)].rows)
        if (e.rows[row].law >= 0 && (b_.is_signal(e.rows[row].law) || !law(e.rows[row].law).is_constant()))
          return b_.is_signal(e.rows[row].law) ? "a signal moves it" : "a law moves it";
      for (const SignalPlan& s : driving_signals(plan_))
        if (s.row >= 0 && s.joint_name == plan_.joints[static_cast<std::size_t>(j)].name)
          return "a signal reads the effort of a joint that holds it";
      if (e.num_efforts > 0) return "a joint that holds it has springs or drives of its own";
    }
    return nullptr;
  }

  bool starts_moving(std::size_t node) const {
    const Vec6<double>& twist = plan_.nodes[node].twist;
    return plan_.is_dynamic && lanes::dot(twist, twist) > 0.0;
  }

  /// Why the multipliers of the joints that hold a node may not follow from the balance of the node alone; null if they
  /// do.
  const char* dependence_of(std::size_t node, const std::vector<int>& joints) const {
    int rows = 0;
    for (int j : joints) rows += num_rows(j);
    return rows > plan_.unknowns.count_of(node) ? "it is held more than once" : loop_from(node, joints);
  }

  /// Examines the joints other than those that hold the node. If they lead to the ground or form a loop, rows may be
  /// linearly dependent. The solver then distributes a load over all of them by least norm, in scales that depend on
  /// the node's unknowns. In a tree of joints that is held at this node only, rows are independent.
  const char* loop_from(std::size_t node, const std::vector<int>& holding) const {
    const Group& group = groups_[group_of_[node]];
    if (group.to_ground > holding.size())
      return "another chain of joints leads from it to the ground: their rows may depend on each other";
    return group.between + 1 == group.nodes ? nullptr
                                            : "joints that it carries form a loop: their rows may depend on each other";
  }

  /// Nodes that joints connect; the ground does not count as a connection.
  struct Group {
    std::size_t nodes = 0, between = 0, to_ground = 0;  ///< joints between two of the nodes, and from one to the ground
  };
  void count_groups() {
    Sets sets(plan_.nodes.size());
    const auto with_rows = [this](auto&& visit) {
      for (const JointPlan& j : plan_.joints)
        if (!j.rows.empty()) visit(joint_of(plan_, j));
    };
    with_rows([&](const elements::Joint& e) {
      if (!is_to_ground(e)) sets.join(sets.index(e.ports[0]), sets.index(e.ports[1]));
    });
    for (std::size_t n = 0; n < plan_.nodes.size(); ++n) ++groups_[group_of_[n] = sets.of(n)].nodes;
    with_rows([&](const elements::Joint& e) {
      const Port& p = e.ports[e.ports[0].node == elements::ground ? 1 : 0];
      if (p.node == elements::ground) return;
      Group& group = groups_[group_of_[static_cast<std::size_t>(p.node)]];
      ++(is_to_ground(e) ? group.to_ground : group.between);
    });
  }

  /// Residual of a joint at the start, its rows after the twelve entries of forces. multipliers: max_rows values, by
  /// row.
  void eval_at_start(int j, const double* multipliers, double* out) const {
    const elements::Joint& e = joint(j);
    elements::PortMotion<double> p[2];
    for (int k = 0; k < 2; ++k) p[k] = {b_.initial_pose(e.ports[k]), Vec6<double>::zero(), Vec6<double>::zero()};
    const elements::Surroundings<double> around{motion::Vec3<double>::zero(), laws_.data(), false};
    elements::eval_residual(e, p, multipliers, around, 0.0, out, out + 12);
  }

  /// Whether the rows of joints with constant laws are satisfied.
  bool are_closed(const std::vector<int>& joints) const {
    for (int j : joints) {
      const double none[elements::max_rows] = {};
      double out[12 + elements::max_rows];
      eval_at_start(j, none, out);
      for (int row : plan_.joints[static_cast<std::size_t>(j)].rows)
        if (!(std::abs(out[12 + row]) <=
              closed * (elements::is_length(joint(j).rows[row].kind) ? plan_.length_scale : 1.0)))
          return false;
    }
    return true;
  }

  /// W at the start, row-major: each column is the wrench on the node of one unit multiplier, in the unknowns of the
  /// node. Precondition: the joints have as many rows as the node has unknowns.
  std::vector<double> wrenches(std::size_t node, const std::vector<int>& joints) const {
    const auto n = static_cast<std::size_t>(plan_.unknowns.count_of(node));
    std::vector<double> W(n * n);
    std::size_t column = 0;
    for (int j : joints) {
      const elements::Joint& e = joint(j);
      const int side = e.ports[0].node == static_cast<int>(node) ? 0 : 1;
      double none[elements::max_rows] = {}, without[12 + elements::max_rows];
      eval_at_start(j, none, without);
      for (int row : plan_.joints[static_cast<std::size_t>(j)].rows) {
        double unit[elements::max_rows] = {}, out[12 + elements::max_rows];
        unit[row] = 1.0;
        eval_at_start(j, unit, out);
        Vec6<double> wrench;
        for (int i = 0; i < 6; ++i) wrench[i] = out[6 * side + i] - without[6 * side + i];
        if (e.ports[side].has_offset) wrench = motion::inverse_adjoint_transpose_times(e.ports[side].offset, wrench);
        double part[6];
        plan_.unknowns.project(wrench, node, part);
        for (std::size_t i = 0; i < n; ++i) W[i * n + column] = part[i];
        ++column;
      }
    }
    return W;
  }

  const Builder& b_;
  const Plan& plan_;
  std::vector<double> laws_;                 ///< values of the constant laws
  std::vector<std::vector<int>> joints_at_;  ///< by node, joints with rows
  std::vector<std::size_t> group_of_;        ///< by node
  std::vector<Group> groups_;                ///< by representative node
};

/// The text of the decision: the first node for which it is taken, how many more, and why not for the first of the
/// others.
struct Account {
  std::string first, obstacle;
  std::size_t count = 0;
  int unknowns = 0;  ///< of all nodes for which it is taken

  void take(const std::string& name, int unknowns_of_node) {
    if (count++ == 0) first = "'" + name + "'";
    unknowns += unknowns_of_node;
  }
  void leave(const std::string& name, const std::string& why) {
    if (obstacle.empty()) obstacle = "'" + name + "': " + why;
  }
  /// "'a' and 2 more do not move: 18 unknowns and 18 rows ...; not 'b': ...".
  std::string reason() const {
    if (count == 0) return obstacle.empty() ? "no joint holds a node to the ground on all sides" : obstacle;
    const std::string rows = std::to_string(unknowns);
    return first + (count == 1 ? " does not move" : " and " + std::to_string(count - 1) + " more do not move") + ": " +
           rows + " unknowns and " + rows + " rows of joints are left out" +
           (obstacle.empty() ? "" : "; not " + obstacle);
  }
};

}  // namespace

void Builder::hold_nodes() {
  const Holder holder(*this);
  std::vector<HeldNode> held;
  Account account;
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const std::vector<int> joints = holder.joints_that_hold(n);
    if (joints.empty()) continue;
    const std::string& name = plan.nodes[n].name;
    HeldNode candidate;
    const auto why = holder.try_to_hold(n, joints, candidate);
    if (why) {
      account.leave(name, *why);
    } else {
      held.push_back(candidate);
      account.take(name, plan.unknowns.count_of(n));
    }
  }
  const bool leaves = held.size() < plan.nodes.size();
  decide("held",
         "nodes that the ground holds at rest have no unknowns, and the joints that hold them no multipliers in the "
         "system: these follow from the forces on the node. Taken where joints and constant displacements leave a node "
         "no motion, "
         "and other joints neither lead from it to the ground nor form a loop",
         !held.empty() && leaves, leaves ? account.reason() : "nothing would be left");
  if (plan.took("held")) plan.held = std::move(held);
}

}  // namespace bough::plan
