#include "bough/scene/problems.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "bough/motion/se3.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/break_limits.hpp"
#include "bough/scene/nearest_name.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

constexpr std::size_t most_kept = 400;  // of problems and of warnings each: twice the number that is shown
constexpr double most_break_work =
    2e7;  // instructions of formulas in searches for breakpoints, some tenths of a second: the run finds the rest

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> r;
  r.reserve(list.size());
  for (const auto& item : list) r.push_back(item.name);
  return r;
}

double model_size(const Scene& scene, const Poses& poses) {
  Vec3 low, high;
  for (int k = 0; k < 3; ++k) {
    low[k] = std::numeric_limits<double>::max();
    high[k] = -low[k];
  }
  const auto include = [&](const Placement& placement) {
    if (const auto pose = poses.of(placement))
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], pose->x[k]);
        high[k] = std::max(high[k], pose->x[k]);
      }
  };
  for (const Node& n : scene.nodes) include(n.placement);
  for (const Body& b : scene.bodies) include(b.placement);
  if (low[0] > high[0]) return 1.0;  // the scene has no nodes or bodies
  double size = 0.0;
  for (int k = 0; k < 3; ++k) size = std::max(size, high[k] - low[k]);
  return std::isfinite(size) && size > 0.0 ? size : 1.0;
}

template <class List>
void check_one_set(ProblemList& list, const char* section, const List& things,
                   std::unordered_map<std::string, std::string>& seen) {
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (things[i].name.empty()) continue;
    const auto [it, is_new] = seen.try_emplace(things[i].name, std::string(section) + " " + std::to_string(i));
    if (!is_new)
      list.add(section, i, "name", things[i].name, "this name is taken already (" + it->second + ")",
               "names are used once");
  }
}

template <class List>
void check_placements(ProblemList& list, const char* section, const List& things) {
  for (std::size_t i = 0; i < things.size(); ++i) {
    const std::string& frame = things[i].placement.frame;
    if (frame.empty() || frame == "ground" || list.is_defective(frame)) continue;
    if (list.check_reference(section, i, "frame", frame, list.frames, "frame") &&
        list.poses.frames().stands_in_itself(*list.poses.frame(frame)))
      list.add(section, i, "frame", frame, "this frame stands in itself, directly or through others");
  }
}

}  // namespace

ProblemList::ProblemList(const Scene& scene_in, std::span<const std::string> defective_in)
    : scene(scene_in), poses(scene_in), defective(defective_in.begin(), defective_in.end()) {
  sections = names_of(scene.sections);
  sensors = names_of(scene.sensors);
  for (std::size_t i = 0; i < sections.size(); ++i) section_of.emplace(sections[i], i);
  for (std::size_t i = 0; i < sensors.size(); ++i) sensor_of.emplace(sensors[i], i);
  joints = names_of(scene.joints);
  beams = names_of(scene.beams);
  frames = names_of(scene.frames);
  places = names_of(scene.nodes);
  for (const Body& b : scene.bodies) places.push_back(b.name);
  places.push_back("ground");
  size = model_size(scene, poses);
  is_dynamic = type_of(scene.analysis.kind).is_in_time;
  last_time = is_dynamic ? scene.analysis.end_time : 1.0;
  if (defective.count("/analysis") > 0) {
    is_dynamic = false;
    last_time = std::numeric_limits<double>::infinity();
  }
}

void ProblemList::add(const char* section, std::size_t index, std::string key, std::string value, std::string rule,
                      std::string hint) {
  put({section, static_cast<int>(index), std::move(key), std::move(value), std::move(rule), std::move(hint), false});
}
void ProblemList::warn(const char* section, std::size_t index, std::string key, std::string value, std::string rule,
                       std::string hint) {
  put({section, static_cast<int>(index), std::move(key), std::move(value), std::move(rule), std::move(hint), true});
}

void ProblemList::put(SceneProblem problem) {
  const int kind = problem.is_warning ? 1 : 0;
  if (num_kept_[kind] == most_kept) {
    ++problems[last_kept_[kind]].more;
    return;
  }
  ++num_kept_[kind];
  last_kept_[kind] = problems.size();
  problems.push_back(std::move(problem));
}

bool ProblemList::is_defective(const std::string& name) const {
  if (defective.count(name) > 0) return true;
  const std::size_t dot_at = name.rfind('.');  // an inner node of a beam that is itself at fault
  return dot_at != std::string::npos && defective.count(name.substr(0, dot_at)) > 0;
}

bool ProblemList::check_reference(const char* section, std::size_t index, const std::string& key,
                                  const std::string& name, const std::vector<std::string>& known, const char* what) {
  if (is_defective(name)) return false;
  if (&known == &sections || &known == &sensors) {
    if ((&known == &sections ? section_of : sensor_of).count(name) > 0) return true;
  } else if (const auto thing = poses.find(name)) {
    const bool fits = &known == &joints  ? thing->kind == ThingKind::joint
                      : &known == &beams ? thing->kind == ThingKind::beam
                                         : thing->kind == ThingKind::frame;
    if (fits) return true;
    add(section, index, key, name, std::string("this is not a ") + what);
    return false;
  }
  return check_known(section, index, key, name, known, what);
}

bool ProblemList::check_known(const char* section, std::size_t index, const std::string& key, const std::string& name,
                              const std::vector<std::string>& known, const char* what) {
  if (is_defective(name)) return false;
  if (std::find(known.begin(), known.end(), name) != known.end()) return true;
  const std::string near = nearest(name, known);
  std::string hint = !near.empty()   ? "did you mean \"" + near + "\"?"
                     : known.empty() ? std::string("the scene has no ") + what
                                     : "";
  add(section, index, key, name, std::string("no ") + what + " has this name", std::move(hint));
  return false;
}

bool ProblemList::check_place(const char* section, std::size_t index, const std::string& key, const std::string& name,
                              bool ground_allowed) {
  if (is_defective(name)) return false;
  if (name.empty() || name == "ground") {
    if (!ground_allowed) add(section, index, key, "ground", "has to be a node or body, not the ground");
    return ground_allowed;
  }
  if (const auto thing = poses.find(name)) {
    if (thing->kind == ThingKind::node || thing->kind == ThingKind::body ||
        (thing->kind == ThingKind::frame && ground_allowed))  // frames are allowed wherever the ground is
      return poses.of(std::string_view(name)).has_value();
    std::string hint;
    if (thing->kind == ThingKind::beam)
      hint = "name one of its ends, or an inner node \"" + name + ".0\" to \"" + name + "." +
             std::to_string(static_cast<long>(scene.beams[thing->index].elements) * scene.beams[thing->index].order) +
             "\"";
    add(section, index, key, name, "this is not a node or body", std::move(hint));
    return false;
  }
  if (const std::size_t dot_at = name.rfind('.'); dot_at != std::string::npos) {
    const auto thing = poses.find(name.substr(0, dot_at));
    if (thing && thing->kind == ThingKind::beam) {
      const Beam& beam = scene.beams[thing->index];
      const long last = static_cast<long>(beam.elements) * beam.order;
      const std::string digits = name.substr(dot_at + 1);
      const bool is_number = !digits.empty() && digits.size() < 9 &&
                             digits.find_first_not_of("0123456789") == std::string::npos &&
                             (digits.size() == 1 || digits[0] != '0');
      if (is_number && std::stol(digits) <= last) return poses.of(std::string_view(name)).has_value();
      add(section, index, key, name, "the inner nodes of this beam are numbered 0 to " + std::to_string(last));
      return false;
    }
  }
  const std::string near = nearest(name, places);
  add(section, index, key, name, "no node or body has this name", near.empty() ? "" : "did you mean \"" + near + "\"?");
  return false;
}

void ProblemList::check_law(const char* section, std::size_t index, const std::string& key, const laws::Law& law,
                            bool with_derivatives) {
  // The value of an integral by quadrature costs the whole way to that time. Its derivatives, which are the integrand,
  // are checked instead.
  const std::optional<laws::Law> integrand = law.integrand();
  const auto value_at = [&](double t) {
    if (!integrand) return law.at(t);
    const laws::LawValue rate = integrand->at(t);
    return laws::LawValue{0.0, rate.value, rate.rate};
  };
  constexpr int samples = 16;
  for (int i = 0; i <= samples; ++i) {
    const double t = std::isfinite(last_time) ? last_time * i / samples : 0.0;
    const laws::LawValue v = value_at(t);
    if (std::isfinite(v.value) && (!with_derivatives || (std::isfinite(v.rate) && std::isfinite(v.acceleration))))
      continue;
    add(section, index, key, "",
        std::string("this law or its derivative is not finite at ") + (is_dynamic ? "t = " : "load factor ") +
            text_of(t),
        with_derivatives ? "a prescribed motion needs a finite velocity and acceleration" : "");
    return;
  }
  check_breaks(section, index, key, law);
}

void ProblemList::check_breaks(const char* section, std::size_t index, const std::string& key, const laws::Law& law) {
  const Analysis& a = scene.analysis;
  const bool is_run = is_dynamic && a.end_time > 0.0 && a.step_size > 0.0 && std::isfinite(a.end_time);
  if (!is_run || law.is_constant() || break_work_ > most_break_work) return;
  const laws::Breaks breaks = law.breakpoints(0.0, end_of_stretch(a, 0.0), most_breaks_a_stretch);
  break_work_ += breaks.work;
  if (breaks.is_cut) add(section, index, key, "", "this law " + too_many_breaks(a, 0.0), fewer_breaks);
}

std::optional<Thing> ProblemList::body_of(const std::string& place) const {
  const auto thing = poses.find(place);
  return thing && thing->kind == ThingKind::body ? thing : std::nullopt;
}

std::string text_of(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}
bool is_zero(const Vec3& a) { return a[0] == 0.0 && a[1] == 0.0 && a[2] == 0.0; }
bool is_zero(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0.0; });
}

bool ProblemList::check_frame(const char* section, std::size_t index, const std::string& frame) {
  if (frame.empty() || frame == "ground" || is_defective(frame)) return true;
  return check_reference(section, index, "frame", frame, frames, "frame");
}

void check_names(ProblemList& list) {
  const Scene& s = list.scene;
  std::unordered_map<std::string, std::string> things, sections, sensors, signals;
  check_one_set(list, "frames", s.frames, things);
  check_one_set(list, "nodes", s.nodes, things);
  check_one_set(list, "bodies", s.bodies, things);
  check_one_set(list, "beams", s.beams, things);
  check_one_set(list, "joints", s.joints, things);
  check_one_set(list, "couplings", s.couplings, things);
  check_one_set(list, "point_loads", s.point_loads, things);
  check_one_set(list, "line_loads", s.line_loads, things);
  check_one_set(list, "motions", s.motions, things);
  check_one_set(list, "sections", s.sections, sections);
  check_one_set(list, "sensors", s.sensors, sensors);
  check_one_set(list, "signals", s.signals, signals);
  check_placements(list, "frames", s.frames);
  check_placements(list, "nodes", s.nodes);
  check_placements(list, "bodies", s.bodies);
}

std::vector<SceneProblem> problems_in(const Scene& scene, std::span<const std::string> defective) {
  ProblemList list(scene, defective);
  check_names(list);
  check_frames(list);
  check_sections(list);
  check_bodies(list);
  check_beams(list);
  check_joints(list);
  check_couplings(list);
  check_loads(list);
  check_motions(list);
  if (defective.empty()) check_initial_velocities(list);
  check_magnitudes(list);
  check_units(list);
  check_signals(list);
  check_sensors(list);
  check_analysis(list);
  if (defective.empty()) check_holding(list);
  return std::move(list.problems);
}

}  // namespace bough::scene
