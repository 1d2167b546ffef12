#pragma once
#include <cstdio>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "bough/motion/norm.hpp"
#include "bough/scene/components.hpp"
#include "bough/scene/nearest_name.hpp"
#include "bough/scene/poses.hpp"
#include "bough/scene/problems.hpp"

namespace bough::scene {

/// State and functions shared by all checks of a scene.
struct ProblemList {
  ProblemList(const Scene& scene_in, std::span<const std::string> defective_in);

  const Scene& scene;
  Poses poses;
  std::unordered_set<std::string> defective;
  std::vector<SceneProblem> problems;
  std::vector<std::string> sections, sensors, joints, beams, places,
      frames;                                                          ///< names that references are compared with
  std::unordered_map<std::string, std::size_t> section_of, sensor_of;  ///< first of a name, in the scene's lists
  double size = 1.0;  ///< of the model: diagonal of the box around all nodes and bodies [m]; 1 where that is 0
  bool is_dynamic = false;
  double last_time = 1.0;  ///< end time [s], or load factor 1

  void add(const char* section, std::size_t index, std::string key, std::string value, std::string rule,
           std::string hint = {});
  void warn(const char* section, std::size_t index, std::string key, std::string value, std::string rule,
            std::string hint = {});
  bool is_defective(const std::string& name) const;

  /// Checks a reference to a place: a node, a body, an inner node, or the ground where allowed. True if the place can
  /// be used.
  bool check_place(const char* section, std::size_t index, const std::string& key, const std::string& name,
                   bool ground_allowed);
  /// Checks a reference into a list of names. True if the name exists.
  bool check_reference(const char* section, std::size_t index, const std::string& key, const std::string& name,
                       const std::vector<std::string>& known, const char* what);
  /// The same for names of several lists together.
  bool check_known(const char* section, std::size_t index, const std::string& key, const std::string& name,
                   const std::vector<std::string>& known, const char* what);
  /// Checks the name of a frame; the ground is allowed.
  bool check_frame(const char* section, std::size_t index, const std::string& frame);
  /// Checks that a law is finite over the analysis, with its derivatives if it prescribes a motion.
  void check_law(const char* section, std::size_t index, const std::string& key, const laws::Law& law,
                 bool with_derivatives);

  std::string nearest(const std::string& name, const std::vector<std::string>& known) {
    return search_.nearest(name, known);
  }

  std::optional<Thing> body_of(const std::string& place) const;  ///< the body of that name, if it is one

 private:
  void put(SceneProblem problem);
  void check_breaks(const char* section, std::size_t index, const std::string& key, const laws::Law& law);

  std::size_t num_kept_[2] = {0, 0}, last_kept_[2] = {0, 0};  ///< of problems and of warnings: the number kept, and the
                                                              ///< index of the last one
  double break_work_ = 0.0;  ///< number of formula instructions executed in searches for breakpoints
  NameSearch search_;
};

using motion::norm;
std::string text_of(double x);
bool is_zero(const Vec3& a);
bool is_zero(std::span<const double> numbers);

enum class Definite { positive, semi };
/// Empty, or what is wrong with a matrix that has to be symmetric and positive (semi-) definite.
std::string definite_fault(const Mat6& a, Definite wanted);

/// Checks the part of an effort that a signal or a sensor names.
void check_effort_part(ProblemList& list, const char* section, std::size_t index, const std::string& of,
                       const Joint& joint);

void check_names(ProblemList& list);
void check_frames(ProblemList& list);
void check_sections(ProblemList& list);
void check_bodies(ProblemList& list);
void check_beams(ProblemList& list);
void check_joints(ProblemList& list);
void check_couplings(ProblemList& list);
void check_loads(ProblemList& list);
void check_motions(ProblemList& list);
void check_initial_velocities(ProblemList& list);
void check_magnitudes(ProblemList& list);
void check_units(ProblemList& list);
void check_signals(ProblemList& list);
void check_sensors(ProblemList& list);
void check_analysis(ProblemList& list);
void check_holding(ProblemList& list);

}  // namespace bough::scene
