/// Rigid parts: nodes and bodies that fixed joints connect become one node.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "bough/plan/sets.hpp"
#include "bough/scene/signals.hpp"
#include "geometry.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using motion::Frame;
using motion::Mat3;
using motion::Mat6;
using motion::Vec3;
using motion::Vec6;

namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Used before elements are numbered, when joints of the plan and of the array correspond one to one.
const elements::Joint& joint_at(const Plan& plan, std::size_t j) { return array_of<elements::Joint>(plan.elements)[j]; }

/// An offset in which round-off of the places it was computed from, of size `reach`, is set to zero. Elements at
/// coincident nodes of a part then need no offset, and equal parts stay equal, so that they can share lanes.
Frame<double> cleared(Frame<double> H, double reach) {
  constexpr double turns = 1e-14, places = 8.0 * std::numeric_limits<double>::epsilon();
  if (length_of(motion::log_so3(H.R)) <= turns) H.R = Mat3<double>::identity();
  if (length_of(H.x) <= places * reach) H.x = Vec3<double>::zero();
  return H;
}

/// Mass matrix M transformed to another frame, in which the body's own frame has the pose H: v_body = Ad(H)^-1 v.
Mat6<double> seen_from_node(const Frame<double>& H, const Mat6<double>& mass) {
  const Mat6<double> A = motion::inverse_adjoint(H), M = lanes::transpose_times(A, mass * A);
  return 0.5 * (M + lanes::transpose(M));
}

/// Sets of nodes, and the ground, that are connected by two or more paths over joints: the rows of joints within one
/// set may be linearly dependent.
Sets loops_of_joints(const Plan& plan) {
  const std::size_t count = plan.nodes.size() + 1;
  Sets loops(plan.nodes.size());
  std::vector<std::vector<std::size_t>> joints_at(count);
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    for (const Port& p : joint_at(plan, j).ports) joints_at[loops.index(p)].push_back(j);
  std::vector<std::size_t> depth(count, none), parent(count, none), front;
  std::vector<bool> is_in_tree(plan.joints.size(), false);
  for (std::size_t top = count; top-- > 0;) {  // the ground first
    if (depth[top] != none) continue;
    depth[top] = 0;
    front.assign(1, top);
    for (std::size_t k = 0; k < front.size(); ++k)
      for (std::size_t j : joints_at[front[k]])
        for (const Port& p : joint_at(plan, j).ports)
          if (const std::size_t next = loops.index(p); depth[next] == none) {
            depth[next] = depth[front[k]] + 1;
            parent[next] = front[k];
            is_in_tree[j] = true;
            front.push_back(next);
          }
  }
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    if (is_in_tree[j]) continue;
    const elements::Joint& e = joint_at(plan, j);
    std::size_t a = loops.of(e.ports[0]), b = loops.of(e.ports[1]);
    while (a != b) {  // up the tree to the common ancestor
      if (depth[a] < depth[b]) std::swap(a, b);
      loops.join(a, parent[a]);
      a = loops.of(a);
    }
  }
  return loops;
}

class Welder {
 public:
  explicit Welder(Builder& b) : b_(b), plan_(b.plan), parts_(b.plan.nodes.size()), loops_(b.plan.nodes.size()) {
    for (const scene::Sensor& s : b.scene.sensors)
      for (const std::string* name : {&s.joint, &s.part})
        if (!name->empty()) asked_.insert(*name);
    for (const scene::Signal& s : b.scene.signals)
      if (scene::reads_reaction(s) || s.kind == scene::SignalKind::force)
        asked_.insert(s.part.empty() ? s.joint : s.part);
    if (asked_.empty()) return;
    loops_ = loops_of_joints(plan_);
    for (std::size_t j = 0; j < plan_.joints.size(); ++j)
      if (asked_.count(plan_.joints[j].name) > 0 && is_in_loop(joint(j)))
        asked_in_loop_.emplace(loops_.of(joint(j).ports[0]), plan_.joints[j].name);
  }

  /// Finds the joints that can be removed, and the node to which each node is welded.
  void find() {
    root_of_.resize(plan_.nodes.size());
    for (std::size_t n = 0; n < root_of_.size(); ++n) root_of_[n] = n;
    goes_.assign(plan_.joints.size(), false);
    for (std::size_t j = 0; j < b_.scene.joints.size(); ++j) {  // these come first in Plan::joints, one for one
      const scene::Joint& given = b_.scene.joints[j];
      const elements::Joint& e = joint(j);
      if (given.kind != scene::JointKind::fixed || e.ports[0].node == elements::ground ||
          e.ports[1].node == elements::ground)
        continue;
      if (const auto why = obstacle_to(given.name, e)) {
        leave("joint '" + given.name + "'", *why);
        continue;
      }
      goes_[j] = true;
      tie(j);
    }
    keep_parts_that_something_closes();
    choose_roots();
  }

  bool finds_any() const { return num_nodes_ > 0; }
  std::string reason() const {
    if (!finds_any()) return obstacle_.empty() ? "no fixed joint ties nodes to each other" : obstacle_;
    const auto joints = static_cast<std::size_t>(std::count(goes_.begin(), goes_.end(), true));
    return first_ + (num_nodes_ == 1 ? "" : " and " + std::to_string(num_nodes_ - 1) + " more of this or others") +
           ": " + std::to_string(num_nodes_) + (num_nodes_ == 1 ? " node and " : " nodes and ") +
           std::to_string(joints) + (joints == 1 ? " fixed joint are left out" : " fixed joints are left out") +
           (obstacle_.empty() ? "" : "; not " + obstacle_);
  }

  void apply() {
    place_nodes();
    move_elements();
    move_names();
    condense_bodies();
    remove_joints();
    std::vector<NodePlan> nodes;
    for (std::size_t n = 0; n < root_of_.size(); ++n)
      if (root_of_[n] == n) nodes.push_back(plan_.nodes[n]);
    plan_.nodes = std::move(nodes);
  }

 private:
  void leave(const std::string& what, const std::string& why) {
    if (obstacle_.empty()) obstacle_ = what + ": " + why;
  }

  /// Why a fixed joint cannot be removed; empty if it can.
  std::optional<std::string> obstacle_to(const std::string& name, const elements::Joint& e) {
    if (b_.scene.analysis.arc_length) return "lengths along the path of equilibria are means over the nodes";
    if (plan_.is_dynamic && b_.scene.analysis.step_control) return "steps are controlled by the error of every node";
    if (plan_.is_dynamic && b_.scene.analysis.newton == scene::Newton::single)
      return "one solution a step keeps errors of a prediction that is chosen by all nodes";
    if (asked_.count(name) > 0) return "its reaction is asked for";
    if (is_in_loop(e))
      if (const auto other = asked_in_loop_.find(loops_.of(e.ports[0])); other != asked_in_loop_.end())
        return "it is in a loop with '" + other->second + "', whose reaction is asked for: rows may share a load";
    const Frame<double> gap = motion::relative(b_.initial_pose(e.ports[0]), b_.initial_pose(e.ports[1]));
    if (!(length_of(gap.x) <= closed * plan_.length_scale && length_of(motion::log_so3(gap.R)) <= closed))
      return "its two sides do not start where it joins them";
    if (plan_.is_dynamic && !starts_as_one(node_at(e.ports[0]), node_at(e.ports[1])))
      return "its two sides do not start with one motion";
    return std::nullopt;
  }

  bool is_in_loop(const elements::Joint& e) { return loops_.of(e.ports[0]) == loops_.of(e.ports[1]); }
  const NodePlan& node_at(const Port& p) const { return plan_.nodes[static_cast<std::size_t>(p.node)]; }

  bool starts_as_one(const NodePlan& a, const NodePlan& b) const {
    const Vec6<double> off = b.twist - motion::inverse_adjoint_times(motion::relative(a.pose, b.pose), a.twist);
    const double turning = length_of(lanes::angular_part(a.twist)) + length_of(lanes::angular_part(b.twist)),
                 speed = length_of(lanes::linear_part(a.twist)) + length_of(lanes::linear_part(b.twist)) +
                         turning * plan_.length_scale;
    return length_of(lanes::linear_part(off)) <= closed * speed &&
           length_of(lanes::angular_part(off)) <= closed * turning;
  }

  /// Calls visit(element, its owner) for all elements except removed joints.
  template <class Visit>
  void for_each_other(Visit&& visit) {
    const auto each = [&](auto& array) {
      using E = typename std::decay_t<decltype(array)>::value_type;
      for (std::size_t i = 0; i < array.size(); ++i) {
        if constexpr (E::role == elements::Role::joint)
          if (goes_[i]) continue;
        visit(array[i], b_.owners<E>()[i]);
      }
    };
    std::apply([&](auto&... arrays) { (each(arrays), ...); }, plan_.elements);
  }

  /// The block graph allows no element with both ends at one node, such as a beam or spring within a rigid part, or a
  /// joint that closes a loop with a gap. Such a part is left as given.
  void keep_parts_that_something_closes() {
    std::set<std::size_t> kept;
    for_each_other([&](const auto& e, const std::string& owner) {
      for (const Port& p : e.ports)
        for (const Port& q : e.ports) {
          if (&p == &q || p.node == elements::ground || q.node == elements::ground || parts_.of(p) != parts_.of(q))
            continue;
          kept.insert(parts_.of(p));
          leave("the part of '" + node_at(p).name + "'", "'" + owner + "' would have both ends at one node");
        }
    });
    for (std::size_t j = 0; j < goes_.size(); ++j)
      if (goes_[j] && kept.count(parts_.of(joint(j).ports[0])) > 0) goes_[j] = false;
    parts_ = Sets(plan_.nodes.size());
    for (std::size_t j = 0; j < goes_.size(); ++j)
      if (goes_[j]) tie(j);
  }

  /// Chooses the node of a part to which most of its elements and joints are attached, the first of several. Their
  /// ports need no offset, and equal hubs stay equal, so that they can share lanes. Bodies do not count, since their
  /// masses are transferred to the node.
  void choose_roots() {
    std::vector<std::size_t> meets(plan_.nodes.size(), 0), best(plan_.nodes.size(), none);
    for_each_other([&](const auto& e, const std::string&) {
      if constexpr (std::decay_t<decltype(e)>::role != elements::Role::body)
        for (const Port& p : e.ports)
          if (p.node != elements::ground) ++meets[static_cast<std::size_t>(p.node)];
    });
    for (std::size_t j = 0; j < goes_.size(); ++j)
      if (goes_[j])
        for (const Port& p : joint(j).ports) ++meets[static_cast<std::size_t>(p.node)];
    for (std::size_t n = 0; n < meets.size(); ++n)
      if (std::size_t& root = best[parts_.of(n)]; root == none || meets[n] > meets[root]) root = n;
    for (std::size_t n = 0; n < meets.size(); ++n) {
      root_of_[n] = best[parts_.of(n)];
      if (root_of_[n] == n) continue;
      if (num_nodes_++ == 0)
        first_ = "'" + plan_.nodes[n].name + "' becomes part of '" + plan_.nodes[root_of_[n]].name + "'";
    }
  }

  /// Uses the poses at the start as they are, so that gaps of joints strain no element.
  void place_nodes() {
    int next = 0;
    std::vector<int> number(root_of_.size(), -1);
    for (std::size_t n = 0; n < root_of_.size(); ++n)
      if (root_of_[n] == n) number[n] = next++;
    for (std::size_t n = 0; n < root_of_.size(); ++n) {
      const Frame<double>&root = plan_.nodes[root_of_[n]].pose, &own = plan_.nodes[n].pose;
      number_.push_back(number[root_of_[n]]);
      offset_.push_back(root_of_[n] == n ? Frame<double>::identity()
                                         : cleared(motion::relative(root, own), length_of(root.x) + length_of(own.x)));
    }
  }

  void move(Port& p) const {
    if (p.node == elements::ground) return;
    const auto n = static_cast<std::size_t>(p.node);
    p.node = number_[n];
    const Frame<double>& offset = offset_[n];
    if (is_identity(offset)) return;
    p.offset =
        p.has_offset ? cleared(motion::compose(offset, p.offset), length_of(offset.x) + length_of(p.offset.x)) : offset;
    p.has_offset = !is_identity(p.offset);
  }

  void move_elements() {
    for (std::size_t j = 0; j < goes_.size(); ++j) {
      if (!goes_[j]) continue;
      const elements::Joint& e = joint(j);
      plan_.welds.push_back({plan_.joints[j].name, e.ports[0], e.ports[1]});
      for (Port* p : {&plan_.welds.back().first, &plan_.welds.back().second}) move(*p);
    }
    for (SignalPlan& s : plan_.signals)
      for (Port& p : s.reading.ports) move(p);
    for_each_other([&](auto& e, const std::string&) {
      if constexpr (std::decay_t<decltype(e)>::role == elements::Role::body) {
        const auto n = static_cast<std::size_t>(e.ports[0].node);
        if (!is_identity(offset_[n])) e.mass = seen_from_node(offset_[n], e.mass);
        e.ports[0].node = number_[n];
      } else {
        for (Port& p : e.ports) move(p);
      }
    });
  }

  void move_names() {
    for (BeamPlan& beam : plan_.beams)
      for (int& node : beam.nodes) node = number_[static_cast<std::size_t>(node)];
    for (BodyPlan& body : plan_.bodies) {
      move(body.frame);
      for (Port& p : body.attachments) move(p);
    }
    for (auto& [name, node] : b_.node_of) {
      const auto n = static_cast<std::size_t>(node);
      if (root_of_[n] != n)
        if (const auto [own, is_new] = b_.part_offset.emplace(name, offset_[n]); !is_new)
          own->second = motion::compose(offset_[n], own->second);
      node = number_[n];
    }
  }

  /// Leaves one body per node, which keeps the name of the first.
  void condense_bodies() {
    std::vector<elements::RigidBody>& bodies = array_of<elements::RigidBody>(plan_.elements);
    std::vector<std::string>& owners = b_.owners<elements::RigidBody>();
    std::map<int, std::size_t> at;
    std::size_t count = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const auto [body, is_first] = at.emplace(bodies[b].ports[0].node, count);
      if (is_first) {
        bodies[count] = bodies[b];
        owners[count++] = owners[b];
      } else {
        bodies[body->second].mass += bodies[b].mass;
      }
    }
    bodies.resize(count);
    owners.resize(count);
  }

  void remove_joints() {
    std::vector<elements::Joint>& joints = array_of<elements::Joint>(plan_.elements);
    std::vector<std::string>& owners = b_.owners<elements::Joint>();
    std::size_t count = 0;
    plan_.num_multipliers = 0;
    for (std::size_t j = 0; j < goes_.size(); ++j) {
      if (goes_[j]) continue;
      joints[count] = joints[j];
      owners[count] = owners[j];
      plan_.joints[count] = plan_.joints[j];
      JointPlan& p = plan_.joints[count];
      p.element = static_cast<int>(count++);
      p.multiplier_begin = plan_.num_multipliers;
      plan_.num_multipliers += joints[static_cast<std::size_t>(p.element)].num_rows;
    }
    joints.resize(count);
    owners.resize(count);
    plan_.joints.resize(count);
  }

  const elements::Joint& joint(std::size_t j) const { return joint_at(plan_, j); }
  void tie(std::size_t j) { parts_.join(parts_.index(joint(j).ports[0]), parts_.index(joint(j).ports[1])); }

  Builder& b_;
  Plan& plan_;
  Sets parts_, loops_;
  std::set<std::string> asked_;                       ///< joints that sensors name
  std::map<std::size_t, std::string> asked_in_loop_;  ///< the first one of each set of loops_
  std::vector<bool> goes_;                            ///< by joint: it is removed
  std::vector<std::size_t> root_of_;                  ///< by node: the node to which it is welded, or itself
  std::vector<int> number_;                           ///< by node: number of its root after renumbering
  std::vector<Frame<double>> offset_;                 ///< by node: pose relative to its root
  std::size_t num_nodes_ = 0;                         ///< number of nodes that are welded to others
  std::string first_, obstacle_;
};

}  // namespace

void Builder::weld_nodes() {
  Welder welder(*this);
  welder.find();
  decide(
      "welded",
      "nodes and bodies that fixed joints tie to each other are one node, elements meet it at constant offsets, masses "
      "are added up: neither unknowns nor multipliers stand for what is rigid. Taken for joints that are closed at the "
      "start, whose sides start with one motion and whose reactions nobody asks for",
      welder.finds_any(), welder.reason());
  if (plan.took("welded")) welder.apply();
}

}  // namespace bough::plan
