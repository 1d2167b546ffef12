#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/scene/joint_kinds.hpp"
#include "bough/scene/poses.hpp"
#include "bough/scene/scene.hpp"
#include "read_values.hpp"
#include "scene_files.hpp"

namespace bough::io {

/// A number with all its digits, in brackets.
std::string in_brackets(double x);

/// Applies overrides "/pointer=value" to a document. texts: stores the texts of the values; text i is the source i + 1
/// of the new values.
void apply_overrides(JsonValue& root, std::span<const std::string> overrides, std::vector<std::string>& texts,
                     std::vector<PlacedFault>& faults);

/// Converts a checked document to a scene. Items with faults, found by the check or here, are omitted and named in
/// `defective`.
class Converter : private ValueConverter {
 public:
  /// folder: that of the files that the scene names; empty: it may not name files.
  Converter(const JsonValue& root, const std::filesystem::path& folder) : files(folder), root_(root) {}
  void convert();

  scene::Scene scene;
  std::vector<std::string> defective;
  SceneFiles files;
  using ValueConverter::faults;
  using ValueConverter::warnings;
  std::map<std::string, std::vector<std::string>> pointers;  ///< of the items of each list of the scene

 private:
  scene::LoadAxes axes(const Value& v) const;
  std::string frame_name(const Value& v) const;
  laws::Law load_law(const Value& object, const std::string& at, std::string& signal);

  // Parts (read_scene_parts.cpp).
  void frame(const Value& v, const std::string& at);
  void material(const Value& v, const std::string& at);
  void section(const Value& v, const std::string& at);
  void node(const Value& v, const std::string& at);
  void body(const Value& v, const std::string& at);
  void beam(const Value& v, const std::string& at);
  void choose_mesh(const Value& v, scene::Beam& b);
  void tell_meshes();
  std::vector<std::array<double, 2>> corners(const Value& list) const;
  std::optional<scene::Outline> outline(const Value& v, const std::string& at);
  void body_looks(const Value& v, const std::string& at, scene::Body& body);
  bool is_sound(const scene::Outline& outline, const std::string& at);
  std::optional<scene::SectionShape> section_shape(const Value& v, const std::string& at);
  scene::Section shaped_section(const Value& v, const std::string& at);
  scene::Mat6 section_mass(const Value& v) const;
  const scene::Material* material_named(const std::string& name, const std::string& at);
  void body_inertia(const Value& v, const std::string& at, scene::Body& body);

  // Connections (read_scene_joints.cpp).
  struct Side {
    scene::Attachment to;
    bool has_position = false, has_rotation = false;
  };
  Side side(const Value& v, const std::string& at);
  scene::Attachment attachment(const Value& v, const std::string& at) { return side(v, at).to; }
  std::optional<scene::Frame> common_frame(const Value& v, const std::string& at, const scene::JointType& type,
                                           const Side& a, const Side& b);
  void place_sides(const Value& v, const std::string& at, const scene::JointType& type, Side& a, Side& b);
  void joint(const Value& v, const std::string& at);
  void coupling(const scene::CouplingKind& kind, const Value& v, const std::string& at);

  // Signals (read_scene_signals.cpp).
  void find_signal_names();
  void signal_formula(const Value& v, const std::string& at, scene::Signal& s);
  void signal_surface(const Value& v, const std::string& at, scene::Signal& s);
  std::string unused_signal_name(std::string name);
  void add_signal(scene::Signal signal, const std::string& at);
  scene::Joint* joint_named(const std::string& name);
  bool is_defective(const std::string& name);
  void take_in_units(const Value& v, const std::string& at, double nominal, scene::Signal& s);
  void reaction(const Value& component, const std::string& at, scene::Signal s);
  void force(const Value& v, const std::string& at, scene::Signal s);
  void add_turned(scene::Signal s, double sign, const std::string& at);
  std::string effort_part(const Value& v) const;
  std::string unit_of(const Value& v, const std::string& at);
  void signal(const Value& v, const std::string& at);
  laws::Law law_or_signal(const Value& v, const std::string& at, std::string& signal);

  // What signals drive and what is made of other parts (read_scene_driven.cpp).
  struct Weight {
    std::string along;  ///< part of the names of its loads
    scene::Vec3 direction;
    laws::Law law;
    std::string signal;
  };
  void need_signal(const std::string& name, const std::string& at);
  std::string signal_of(const Value& v, const std::string& at, const std::string& name);
  void driven_spring(const Value& v, const std::string& at, const scene::Coupling& spring);
  void driven_gravity(const Value& v);
  void weigh();

  // Servos (read_scene_actuators.cpp).
  struct Servo {
    std::string name, stem, coordinate;
    scene::Joint* joint = nullptr;
    bool is_length = false;
    std::optional<double> limit, lag;
  };
  void actuator(const Value& v, const std::string& at);
  scene::Joint* joint_to_drive(const std::string& name, const std::string& at);
  bool find_coordinate(const Value& v, const std::string& at, Servo& servo);
  void add_effort(const Value& v, const Servo& servo, const std::string& wanted, std::vector<std::string> inputs,
                  const std::string& at);
  std::string rate_of(const Value& target, const std::string& at, const std::string& name);
  std::string rate_of_signal(const std::string& signal, const std::string& at, const std::string& name);
  std::string add_time(const laws::Law& law, const std::string& name, const std::string& at);

  // The rest (read_scene_rest.cpp).
  void load(const Value& v, const std::string& at);
  void motion(const Value& v, const std::string& at);
  void initial_velocity(const Value& v, const std::string& at);
  void sensor(const Value& v, const std::string& at);
  void read_expected_value(const Value& v, scene::Expected& e) const;
  void expected(const Value& v, const std::string& at);
  void measure(const Value& v, const std::string& at);
  void read_measured_names(const Value& v, const std::string& at, scene::Measure& m);
  void settings();

  // Hints for numbers in units other than SI, and for settings without effect.
  void warn_of_units(const scene::Material& material, const std::string& at);
  void warn_of_density(double density, const std::string& at, const std::string& name);
  void warn_of_thickness(const JsonValue& shape, const scene::Material& material, const std::string& at);
  void warn_of_body_size(const JsonValue& body, const std::string& at, double density);
  void warn_of_thick_beams();
  std::vector<std::string> beams_without_mesh;  ///< whose elements the scene does not give
  void tell_places_in_chosen_meshes();
  std::vector<std::pair<std::string, std::string>> inner_nodes;  ///< named as places, and where
  void warn_of_degrees(const laws::Law& angle, const std::string& at);
  using ValueConverter::warn_of_degrees;
  scene::SolverForm read_form(const Value& solver);
  void warn_of_idle_settings(const Value& analysis);

  std::string own_name(const Value& v, const char* stem);
  /// Converts all items of a list; those with faults become defective.
  void each(const char* list, const std::function<void(const Value&, const std::string&)>& read);
  void each(const char* list, void (Converter::*read)(const Value&, const std::string&)) {
    each(list, [this, read](const Value& v, const std::string& at) { (this->*read)(v, at); });
  }
  template <class T>
  void add(std::vector<T>& list, const char* name, T item, const std::string& at) {
    if (faults.size() != faults_before_ || left_out_) return;
    list.push_back(std::move(item));
    pointers[name].push_back(at);
  }

  const JsonValue& root_;
  std::size_t faults_before_ = 0;  ///< number of faults of the items before this one
  bool left_out_ = false;          ///< this item refers to an omitted one
  bool is_static_ = false;
  std::vector<scene::Material> materials_;
  std::unordered_map<std::string, double> thickness_;  ///< of sections of a given shape: its largest dimension [m]
  std::unordered_map<std::string, std::size_t> material_of_;  ///< by name, in materials_
  std::unordered_set<std::string> defective_materials_;       ///< omitted; their faults were reported
  std::unordered_set<std::string> names_;                     ///< all names given in the file
  std::unordered_set<std::string> measure_names_;
  std::vector<std::string> signal_names_;                  ///< of all signals of the document
  std::unordered_set<std::string> known_signals_;          ///< the same, to look them up
  std::unordered_set<std::string> taken_signal_names_;     ///< of these and of those that the reader makes
  std::unordered_set<std::string> springs_;                ///< names of all of the document that may be struts
  std::unordered_map<std::string, std::size_t> joint_of_;  ///< first joint of each name, of those indexed so far
  std::size_t num_joints_indexed_ = 0;
  std::unordered_set<std::string> defective_names_;  ///< of those indexed so far
  std::size_t num_defective_indexed_ = 0;
  std::unordered_map<std::string, const Value*> given_signals_;  ///< by name; made when first asked for
  std::unordered_map<std::string, std::string> effort_of_;  ///< by joint: the first signal that reads an effort of it
  std::vector<Weight> weights_;                             ///< gravity that is made of loads
  int unnamed_ = 0;
  std::optional<scene::Poses> poses_;
};

}  // namespace bough::io
