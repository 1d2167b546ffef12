#pragma once
/// Working state of make_plan, with one method for each kind of entry in a scene.
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bough/plan/frames.hpp"
#include "bough/plan/plan.hpp"
#include "bough/scene/components.hpp"
#include "bough/scene/poses.hpp"

namespace bough::plan {

template <class Arrays>
struct OwnersOf;
template <class... E>
struct OwnersOf<std::tuple<std::vector<E>...>> {
  template <class T>
  struct Tagged : std::vector<std::string> {};
  using type = std::tuple<Tagged<E>...>;
  template <class T>
  using tag = Tagged<T>;
};

inline const elements::Joint& joint_of(const Plan& plan, const JointPlan& j) {
  return array_of<elements::Joint>(
      plan.elements)[static_cast<std::size_t>(plan.directory[static_cast<std::size_t>(j.element)].index)];
}

/// A dead load in the ground's axes or a follower load: its wrench and its law.
struct SpaceLoad {
  motion::Vec6<double> wrench;
  bool follows = false;
  int law = 0;
};

class Sets;

struct Builder {
  explicit Builder(const scene::Scene& scene);

  const scene::Scene& scene;
  Plan plan;
  scene::Poses poses;
  std::unordered_map<std::string, int> node_of;
  OwnersOf<ElementArrays>::type owner_lists;
  std::map<std::string, std::vector<SpaceLoad>> line_loads;  ///< by name: one law for all elements under a line load
  std::unordered_map<std::string, const scene::Section*> section_of;                   ///< by name
  std::unordered_map<std::string, std::vector<const scene::LineLoad*>> loads_of_beam;  ///< by name of the beam
  std::map<std::string, int> carrier_of;                     ///< frames that move in the ground, in Plan::frames
  std::map<std::string, motion::Frame<double>> frame_start;  ///< pose of every frame in the ground
  FrameMotions start_motions;
  std::unordered_map<std::string, int> law_of_signal;           ///< by name: place among the values of laws
  std::unordered_map<std::string, std::string> unit_of_signal;  ///< by name; empty: a pure number, or not known
  std::map<std::string, motion::Frame<double>> part_offset;  ///< pose of a named part relative to the node to which it
                                                             ///< is welded
  std::vector<std::pair<int, motion::Vec3<double>>> spinless;  ///< nodes that do not spin about a line of their own
                                                               ///< axes
  std::vector<std::string> held_at_lines;                      ///< names of these point masses

  double written_precision = 0.0;  ///< relative, of places and directions; 0: they are meant as they stand
  int written_decimals = 0;

  template <class E>
  std::vector<std::string>& owners() {
    return std::get<OwnersOf<ElementArrays>::tag<E>>(owner_lists);
  }
  /// Returns its index within its array: elements are numbered array after array once all are known, and until then
  /// each keeps the name of its owner.
  template <class E>
  int add(const E& e, const std::string& owner) {
    array_of<E>(plan.elements).push_back(e);
    owners<E>().push_back(owner);
    return static_cast<int>(owners<E>().size()) - 1;
  }

  int add_law(const laws::Law& law, const std::string& user);
  int add_factor(const laws::Law& law, const std::string& user);
  int add_factor(const laws::Law& law, const std::string& signal, const std::string& user);
  const std::vector<SpaceLoad>& line_load(const scene::LineLoad& load);
  std::vector<SpaceLoad> space_loads(const motion::Vec3<double>& force, const motion::Vec3<double>& moment,
                                     const std::string& frame, bool follows, int law, const std::string& user);
  motion::Vec6<double> frame_velocity(const std::string& frame, const motion::Vec3<double>& at) const;
  int add_drive(const laws::Law& law, const std::string& signal, bool is_rate, double initial, const std::string& user);
  int add_node(const std::string& name, const motion::Frame<double>& pose);
  int add_joint(elements::Joint& joint, const std::string& name, const std::string& what);
  elements::Port port_at(const std::string& to, const motion::Frame<double>& offset) const;
  elements::Port port_at(const scene::Attachment& a) const;
  motion::Frame<double> initial_pose(const elements::Port& port) const;

  void align_at_start(scene::CouplingStart start, elements::Port& first, elements::Port& second) const;

  /// Places for the values of signals among those of laws; then the signals themselves.
  void add_signal_laws();
  void add_signals();
  /// Puts signals that elements read, themselves or by others, before those that only observe.
  void part_signals();
  double extent_of_joints() const;
  static EffortPlan read_effort(const scene::Joint& joint, const elements::Joint& made, motion::RowKind coordinate,
                                const std::string& of);
  /// Whether a place among the values of laws is that of a signal that is an unknown.
  bool is_signal(int law) const {
    const auto i = static_cast<std::size_t>(law);
    return i < plan.signal_of_law.size() && plan.signal_of_law[i] >= 0;
  }
  void add_frames();
  void add_bodies();
  void add_beams();
  void add_joints();
  void add_motions();
  void add_couplings();
  /// Finds point masses whose rotation has no effect.
  void find_points();
  void keep_from_spinning(std::size_t body, const std::vector<motion::Vec3<double>>& met);
  void add_initial_velocities();
  void turn_points_with_their_parts();
  void list_given_velocities();
  void stop_spins();
  void list_attachments();
  void weld_nodes();
  /// Marks bodies that are points at their origins, judged by their final mass matrix.
  void mark_points();
  void number_elements();
  double size_of_structure() const;
  /// Computes the lengths of the parts that joints connect; needs length_scale.
  void measure_joints();
  bool is_barred(const std::string& decision) const;  ///< by Scene::without
  /// Records a decision: it is taken if its condition holds and the scene does not bar it.
  void decide(const std::string& name, const std::string& what, bool holds, const std::string& reason);
  void settle();
  void join_by_signals(Sets& parts) const;
  void say_idle_parts();
  void find_mobility();
  void take_written_precision();
  void choose_unknowns();
  /// Once it is known in which motions the scene can move.
  void leave_out_rotations_of_points();
  void find_massless_rotations();
  void hold_nodes();
  void add_reduced_model(const motion::Mat3<double>& axes);
  void list_signals_of_elements();
  void make_graph();
  std::vector<int> elements_with_force(const std::string& part) const;
  void add_sensors();
  void list_turning_joints();
};

}  // namespace bough::plan
