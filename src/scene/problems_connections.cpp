#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "bough/motion/se3.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/couplings.hpp"
#include "bough/scene/part_lengths.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

constexpr double gap_tolerance = 1e-6;    // relative to the length of the parts that the joint connects
constexpr double typed_tolerance = 1e-6;  // relative to the distance from the origin: places typed with 7 digits are
                                          // accepted, but
constexpr double typed_at_most = 1e-3;    // with a gap of no more than this part of the length of the connected parts
constexpr double angle_tolerance = 1e-6;  // [rad]

std::string in_metres(double x) { return text_of(x) + " m"; }
std::string in_radians(double x) { return text_of(x) + " rad"; }

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// Norm of the values of a joint's rows that are lengths [m].
double gap_of(const Joint& j, const Frame& H) {
  double gap = 0.0;
  for (const JointRow& row : type_of(j.kind).rows)
    if (motion::traits_of(row.kind).is_length && !motion::traits_of(row.kind).is_between_points)
      gap = std::hypot(gap, eval_row(row, j.pitch, H).value);
  return gap;
}

/// Angle by which the joint frames are turned from where its rows hold [rad]. One cosine is that of two axes at a right
/// angle, two keep axes 3 parallel, three keep all axes parallel.
double turn_of(const Joint& j, const Frame& H) {
  double angle = 0.0;
  int cosines = 0;
  for (const JointRow& row : type_of(j.kind).rows) {
    if (motion::traits_of(row.kind).is_length) continue;
    const double value = eval_row(row, j.pitch, H).value;
    const bool is_cosine = row.kind == motion::RowKind::across;
    cosines += is_cosine ? 1 : 0;
    angle = std::hypot(angle, is_cosine ? std::asin(std::clamp(value, -1.0, 1.0)) : value);
  }
  if (cosines == 2) return angle_between(column(H.R, 2), Vec3::unit(2));
  return cosines == 3 ? norm(motion::log_so3(H.R)) : angle;
}

/// Describes why the two joint frames cannot coincide at the start; empty where they do. H: pose of the second in the
/// first.
std::string closure_fault(const Joint& j, const Frame& H, double allowed) {
  if (!type_of(j.kind).has_common_frame() && norm(H.x) <= allowed)
    return "the points of first and second coincide at the start, so the joint has no direction";
  const double gap = gap_of(j, H), turn = turn_of(j, H);
  if (gap > allowed) return "the joint frames of first and second are " + in_metres(gap) + " apart at the start";
  if (turn <= angle_tolerance) return "";
  return (type_of(j.kind).axes == JointAxes::two ? "the two axes are off a right angle by "
                                                 : "the joint frames of first and second are turned by ") +
         in_radians(turn) + " against each other at the start";
}

/// The coordinate of a joint that a drive or a force names; nullptr, and a problem, if it has none of this name.
const JointCoordinate* check_coordinate(ProblemList& list, std::size_t i, const std::string& key,
                                        const std::string& coordinate) {
  const JointType& type = type_of(list.scene.joints[i].kind);
  const auto& known = type.coordinates;
  if (const JointCoordinate* found = type.coordinate(coordinate)) return found;
  if (known.empty())
    list.add("joints", i, key, coordinate, "a " + type.name + " joint has no coordinate to act on");
  else if (coordinate.empty())
    list.add("joints", i, key, "", "say which coordinate: \"" + known[0].name + "\" or \"" + known.back().name + "\"");
  else
    list.add("joints", i, key, coordinate,
             "a " + type.name + " joint has the coordinate \"" + known[0].name + "\" only");
  return nullptr;
}

void check_drives(ProblemList& list, std::size_t i, const Frame* H) {
  const Joint& j = list.scene.joints[i];
  std::set<std::string> driven;
  for (std::size_t k = 0; k < j.drives.size(); ++k) {
    const JointDrive& drive = j.drives[k];
    const std::string key = "drives/" + std::to_string(k);
    const JointCoordinate* coordinate = check_coordinate(list, i, key + "/coordinate", drive.coordinate);
    list.check_law("joints", i, key + "/law", drive.law, true);
    if (!driven.insert(drive.coordinate).second)
      list.add("joints", i, key, drive.coordinate, "this coordinate is driven twice");
    else if (driven.size() > 1 && type_of(j.kind).rows.size() + driven.size() > 6)
      list.add("joints", i, key, drive.coordinate,
               "the " + *driven.begin() + " and the " + *driven.rbegin() + " of a " + to_string(j.kind) +
                   " depend on each other: drive one");
    if (H == nullptr || coordinate == nullptr || drive.is_rate || !drive.signal.empty() || !list.is_dynamic) continue;
    const double now = eval_row({coordinate->kind}, j.pitch, *H).value;
    const double jump = drive.law.at(0.0).value - now;
    const double off = coordinate->is_length() ? std::abs(jump) / list.size
                                               : std::abs(std::remainder(jump, 2.0 * 3.14159265358979323846));
    if (off > gap_tolerance)
      list.warn("joints", i, key + "/law", text_of(drive.law.at(0.0).value),
                "the law jumps at the start: the joint stands at " + text_of(now), "let it start there");
  }
  for (std::size_t k = 0; k < j.forces.size(); ++k) {
    const std::string key = "forces/" + std::to_string(k);
    const JointCoordinate* coordinate = check_coordinate(list, i, key + "/coordinate", j.forces[k].coordinate);
    if (coordinate != nullptr && type_of(j.kind).holds(*coordinate))
      list.add("joints", i, key, j.forces[k].coordinate,
               "the joint holds this coordinate, so a force along it moves nothing", "take a spring, or a drive");
    list.check_law("joints", i, key + "/effort", j.forces[k].effort, false);
  }
}

/// Checks that both sides are places, and not the same one.
template <class Pair>
bool check_pair(ProblemList& list, const char* section, std::size_t i, const Pair& p) {
  bool sound = list.check_place(section, i, "first", p.first.to, true);
  sound = list.check_place(section, i, "second", p.second.to, true) && sound;
  const auto plain = [](const std::string& name) { return name == "ground" ? std::string() : name; };
  const auto stands = [&list](const std::string& name) {
    const auto thing = list.poses.find(name);
    return name.empty() || name == "ground" || (thing && thing->kind == ThingKind::frame);
  };
  if (sound && plain(p.first.to) != plain(p.second.to) && stands(p.first.to) && stands(p.second.to)) {
    list.add(section, i, "second", p.second.to.empty() ? "ground" : p.second.to,
             "first and second are both prescribed: one of them has to be a node or body",
             "a frame moves by its own laws alone");
    return false;
  }
  if (!sound || plain(p.first.to) != plain(p.second.to)) return sound;
  list.add(section, i, "second", p.second.to.empty() ? "ground" : p.second.to, "first and second are the same thing");
  return false;
}

/// Warns of several fixed joints between the same two parts, of which one is enough.
void check_twins(ProblemList& list) {
  std::map<std::pair<std::string, std::string>, std::string> first;
  for (std::size_t i = 0; i < list.scene.joints.size(); ++i) {
    const Joint& j = list.scene.joints[i];
    if (j.kind != JointKind::fixed) continue;
    const auto [twin, is_new] = first.try_emplace(std::minmax(j.first.to, j.second.to), j.name);
    if (!is_new)
      list.warn("joints", i, "name", j.name, "this holds the same two things to each other as '" + twin->second + "'",
                "one of the two is redundant: their reactions are not unique");
  }
}

}  // namespace

void check_joints(ProblemList& list) {
  const PartLengths lengths(list.scene, list.poses);
  for (std::size_t i = 0; i < list.scene.joints.size(); ++i) {
    const Joint& j = list.scene.joints[i];
    const bool has_pitch = type_of(j.kind).has_pitch();
    if (has_pitch && j.pitch == 0.0) list.add("joints", i, "pitch", "", "a screw needs a pitch other than 0");
    if (!has_pitch && j.pitch != 0.0) list.add("joints", i, "pitch", text_of(j.pitch), "only a screw has a pitch");
    std::optional<Frame> H;
    double allowed = 0.0;
    if (check_pair(list, "joints", i, j)) {
      const auto a = list.poses.of(j.first), b = list.poses.of(j.second);
      if (a && b) {
        H = motion::relative(*a, *b);
        const double length = lengths.of_joint(j.first, j.second, list.size);
        allowed = gap_tolerance * length + std::min(typed_tolerance * norm(b->x), typed_at_most * length);
      }
    }
    if (H)
      if (const std::string fault = closure_fault(j, *H, allowed); !fault.empty()) {
        list.add("joints", i, "", "", fault, "give one position (and axis) instead, or move one of the two");
        H.reset();
      }
    check_drives(list, i, H ? &*H : nullptr);
  }
  check_twins(list);
}

namespace {

/// What is wrong with a number, a direction or a matrix of a coupling.
std::string fault_of(const CouplingField& field, std::span<const double> values) {
  if (field.type == CouplingFieldType::number)
    return std::isfinite(values[0]) && values[0] >= field.low && !(field.is_low_open && values[0] == field.low)
               ? ""
               : std::string("has to be ") + (field.is_low_open ? "more than " : "at least ") + text_of(field.low);
  if (field.type == CouplingFieldType::matrix) {
    Mat6 matrix;
    std::copy(values.begin(), values.end(), matrix.m);
    const std::string fault = definite_fault(matrix, Definite::semi);
    return fault.empty() ? "" : std::string("the ") + field.name + " " + fault;
  }
  constexpr double least = 1e-150;  // the square of a smaller length is 0
  const double length = norm(Vec3{{values[0], values[1], values[2]}});
  return length > least && std::isfinite(length) ? "" : "a direction has a length other than 0";
}

void check_coupling(ProblemList& list, std::size_t i) {
  const Coupling& c = list.scene.couplings[i];
  if (c.kind == nullptr) return list.add("couplings", i, "kind", c.name, "this coupling has no kind");
  const auto a = list.poses.of(c.first), b = list.poses.of(c.second);
  if (check_pair(list, "couplings", i, c) && c.kind->acts_along_line && a && b &&
      norm(b->x - a->x) <= 1e-12 * list.size)
    list.add("couplings", i, "second", "",
             std::string("the two ends coincide at the start: the ") + c.kind->name + " has no direction",
             "use a bushing");
  bool acts = false;
  std::size_t known = 0;
  std::string strengths, last;
  std::set<std::string> idle;  // strengths that are zero
  for_each_field(c, [&](const CouplingField& field, std::span<const double> values, const Factor* factor) {
    ++known;
    if (factor != nullptr) {
      list.check_law("couplings", i, field.name, factor->law, false);
      if (factor->is_given() && idle.count(field.multiplied) > 0)
        list.add("couplings", i, field.name, "",
                 std::string("there is no ") + field.multiplied + " that this factor could multiply",
                 std::string("give the ") + field.multiplied + " at the factor 1");
    } else if (const std::string fault = fault_of(field, values); !fault.empty()) {
      list.add("couplings", i, field.name, values.size() == 1 ? text_of(values[0]) : "", fault);
    }
    if (!field.is_strength) return;
    if (!last.empty()) strengths += (strengths.empty() ? "" : ", ") + last;
    last = field.name;
    acts |= !is_zero(values);
    if (is_zero(values)) idle.insert(field.name);
  });
  if (known != c.kind->fields.size())
    list.add("couplings", i, "values", c.name, std::string("these are not the numbers of a ") + c.kind->name);
  if (!last.empty() && !acts)
    list.warn("couplings", i, "", "",
              "without " + (strengths.empty() ? "" : strengths + " and ") + last + " it does nothing");
}

}  // namespace

void check_couplings(ProblemList& list) {
  for (std::size_t i = 0; i < list.scene.couplings.size(); ++i) check_coupling(list, i);
}

namespace {

template <class Load>
void check_load_frame(ProblemList& list, const char* section, std::size_t i, const Load& load) {
  list.check_frame(section, i, load.frame);
  if (!load.frame.empty() && load.axes == LoadAxes::body)
    list.add(section, i, "frame", load.frame, "a follower turns with what it acts on, not with a frame",
             "leave one of \"axes\" and \"frame\" out");
}

}  // namespace

void check_loads(ProblemList& list) {
  const Scene& s = list.scene;
  for (std::size_t i = 0; i < s.point_loads.size(); ++i) {
    const PointLoad& l = s.point_loads[i];
    list.check_place("point_loads", i, "at", l.at.to, false);
    list.check_law("point_loads", i, "law", l.law, false);
    check_load_frame(list, "point_loads", i, l);
    if (is_zero(l.force) && is_zero(l.moment))
      list.warn("point_loads", i, "", "", "the load has neither force nor moment");
    const auto body = list.body_of(l.at.to);
    if (body && s.bodies[body->index].is_point_mass && !is_zero(l.moment))
      list.add("point_loads", i, "moment", "", "a point mass takes no moment");
  }
  for (std::size_t i = 0; i < s.line_loads.size(); ++i) {
    const LineLoad& l = s.line_loads[i];
    list.check_reference("line_loads", i, "beam", l.beam, list.beams, "beam");
    list.check_law("line_loads", i, "law", l.law, false);
    check_load_frame(list, "line_loads", i, l);
    if (is_zero(l.force) && is_zero(l.moment))
      list.warn("line_loads", i, "", "", "the load has neither force nor moment");
  }
  list.check_law("gravity", 0, "law", s.gravity_law, false);
}

namespace {

void check_motion(ProblemList& list, std::size_t i, std::set<std::string>& taken) {
  const PrescribedMotion& m = list.scene.motions[i];
  list.check_place("motions", i, "at", m.at.to, false);
  const auto take = [&](const char* key) {
    if (!taken.insert(m.at.to + "/" + key).second)
      list.add("motions", i, key, m.at.to, "this motion is prescribed twice for the same thing");
  };
  const auto jump = [&](const std::string& key, const laws::Law& law) {
    if (!m.is_rate && list.is_dynamic && std::abs(law.at(0.0).value) > gap_tolerance * list.size)
      list.warn("motions", i, key, text_of(law.at(0.0).value),
                "the law jumps at the start: motions count from the initial pose", "let it start at 0");
  };
  const char* const names[3] = {"x", "y", "z"};
  bool any = false;
  for (int k = 0; k < 3; ++k)
    if (m.displacement[k]) {
      any = true;
      take(names[k]);
      list.check_law("motions", i, names[k], *m.displacement[k], true);
      if (m.displacement_signal[k].empty()) jump(names[k], *m.displacement[k]);
    }
  if (m.rotation_axis || m.hold_rotation) {
    any = true;
    take("rotation");
  }
  if (m.rotation_axis) {
    if (is_zero(*m.rotation_axis))
      list.add("motions", i, "rotation/axis", "0, 0, 0", "an axis has a length other than 0");
    list.check_law("motions", i, "rotation/angle", m.angle, true);
    if (m.angle_signal.empty()) jump("rotation/angle", m.angle);
  }
  if (!any) list.add("motions", i, "", "", "prescribes nothing", "give x, y, z or rotation");
}

}  // namespace

void check_motions(ProblemList& list) {
  const Scene& s = list.scene;
  std::set<std::string> taken, started;
  for (std::size_t i = 0; i < s.motions.size(); ++i) check_motion(list, i, taken);
  for (std::size_t i = 0; i < s.initial_velocities.size(); ++i) {
    const InitialVelocity& v = s.initial_velocities[i];
    list.check_frame("initial_velocities", i, v.frame);
    const auto thing = list.poses.find(v.of);
    if (!thing || thing->kind != ThingKind::beam) list.check_place("initial_velocities", i, "of", v.of, false);
    if (!started.insert(v.of).second)
      list.add("initial_velocities", i, "of", v.of, "this thing has an initial velocity already");
    if (!type_of(s.analysis.kind).is_in_time)
      list.warn("initial_velocities", i, "", "", "the analysis is static: an initial velocity does nothing");
    if (thing && thing->kind == ThingKind::body && s.bodies[thing->index].is_point_mass && !is_zero(v.angular_velocity))
      list.warn("initial_velocities", i, "angular_velocity", "", "a point mass does not turn");
  }
}

}  // namespace bough::scene
