#include <cmath>
#include <iterator>

#include "bough/motion/se3.hpp"
#include "bough/scene/components.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

using scene::Frame;
using scene::JointAxes;
using scene::JointType;
using scene::Vec3;

namespace {

double norm(const Vec3& a) { return std::hypot(a[0], a[1], a[2]); }

/// The inertial axis with the largest angle to `a`, the first of several.
Vec3 far_axis(const Vec3& a) {
  int best = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(a[k]) < std::abs(a[best]) - 1e-6 * norm(a)) best = k;
  return Vec3::unit(best);
}

}  // namespace

Converter::Side Converter::side(const Value& v, const std::string& at) {
  Side s;
  if (v.is(JsonKind::string)) {
    s.to.to = v.text;
  } else {
    s.to.to = v.find("to")->text;
    if (const Value* p = v.find("position")) {
      s.has_position = true;
      s.to.offset.x = vector(*p);
    }
    if (const Value* r = v.find("rotation")) {
      s.has_rotation = true;
      s.to.offset.R = rotation(*r, at + "/rotation");
    }
  }
  if (s.to.to.empty()) fault(v.is(JsonKind::string) ? at : at + "/to", "has to name a node, a body or \"ground\"");
  if (s.to.to == "ground") s.to.to.clear();
  if (s.to.to.find('.') != std::string::npos) inner_nodes.emplace_back(s.to.to, at);
  return s;
}

/// The joint's frame at the start, from position and axes or from the frames on both sides. None if it is not
/// determined. A fault was then reported, or one of the sides does not exist (which the check of references reports).
std::optional<Frame> Converter::common_frame(const Value& v, const std::string& at, const JointType& type,
                                             const Side& a, const Side& b) {
  const auto H_a = poses_->of(std::string_view(a.to.to)), H_b = poses_->of(std::string_view(b.to.to));
  const auto frame = poses_->of(scene::Placement{Frame::identity(), text_or(v, "frame")});
  if (!frame) {
    fault(at + "/frame", "no frame has this name");
    return std::nullopt;
  }
  if (!H_a || !H_b) return std::nullopt;
  const Frame at_a = motion::compose(*H_a, a.to.offset), at_b = motion::compose(*H_b, b.to.offset);
  const bool b_leads =
      b.to.to.empty() ? false : true;  // with bare names the joint is at the second part, unless that is the ground
  Frame joint;
  if (const Value* position = v.find("position")) {
    joint.x = motion::transform(*frame, vector(*position));
    if (a.has_position || b.has_position)
      fault(at + "/position", "the place is given here and in first or second: give one of the two");
  } else if (a.has_position || b.has_position) {
    joint.x = b.has_position ? at_b.x : at_a.x;
  } else {
    joint.x = b_leads ? at_b.x : at_a.x;
    const double gap = norm(at_a.x - at_b.x);
    if (type.rows.size() < 6 && !a.to.to.empty() && b_leads && gap > 1e-9 * (1.0 + norm(at_a.x)))
      fault(at, "needs a position: the origins of first and second are " + std::to_string(gap) + " m apart");
  }
  const Value *axis = v.find("axis"), *second_axis = v.find("second_axis");
  if (axis != nullptr) {
    if (a.has_rotation || b.has_rotation)
      fault(at + "/axis", "the axes are given here and in first or second: give one of the two");
    const Vec3 main = frame->R * vector(*axis);
    if (!(norm(main) > least_axis)) {
      fault(at + "/axis", norm(main) > 0.0 ? "this axis is too short to tell a direction: its length is near 0"
                                           : "an axis has a length other than 0");
      return std::nullopt;
    }
    const Vec3 side = second_axis != nullptr ? Vec3(frame->R * vector(*second_axis)) : far_axis(main);
    if (type.axes == JointAxes::two && second_axis == nullptr) {
      fault(at, "a " + type.name + " joint needs the key \"second_axis\": the axis fixed in the second");
      return std::nullopt;
    }
    if (type.axes == JointAxes::two && std::abs(dot(main, side)) > 1e-9 * norm(main) * norm(side)) {
      fault(at + "/second_axis", "the axes of a " + type.name + " joint are perpendicular");
      return std::nullopt;
    }
    const auto R = scene::axes_from(type.axes == JointAxes::two ? 1 : 3, main, side);
    if (!R) {
      fault(at + "/second_axis", "runs along the axis, or is 0");
      return std::nullopt;
    }
    joint.R = *R;
  } else if (a.has_rotation || b.has_rotation) {
    joint.R = b.has_rotation ? at_b.R : at_a.R;
  } else {
    if (type.axes != JointAxes::none) {
      fault(at, "a " + type.name + " joint needs the key \"axis\"",
            "or a rotation in first or second, whose axis 3 it then is");
      return std::nullopt;
    }
    joint.R = b_leads ? H_b->R : H_a->R;
  }
  return joint;
}

void Converter::place_sides(const Value& v, const std::string& at, const JointType& type, Side& a, Side& b) {
  const auto joint = common_frame(v, at, type, a, b);
  if (!joint) return;
  for (Side* s : {&a, &b}) {
    const Frame offset = motion::relative(*poses_->of(std::string_view(s->to.to)), *joint);
    if (!s->has_position) s->to.offset.x = offset.x;
    if (!s->has_rotation) s->to.offset.R = offset.R;
  }
}

void Converter::joint(const Value& v, const std::string& at) {
  scene::Joint j;
  j.name = v.find("name")->text;
  j.kind = scene::joint_kind_named(v.find("kind")->text).value();  // the schema takes no other names
  const JointType& type = scene::type_of(j.kind);
  Side a = side(*v.find("first"), at + "/first"), b = side(*v.find("second"), at + "/second");
  if (type.has_common_frame()) {
    place_sides(v, at, type, a, b);
  } else {
    for (const char* key : {"position", "axis", "second_axis"})
      if (v.find(key) != nullptr)
        fault(at + "/" + key, "a " + type.name + " joint has no common frame: give the two points in first and second");
  }
  j.first = a.to;
  j.second = b.to;
  j.pitch = number_or(v, "pitch", 0.0);
  const auto coordinate = [&](const Value& item) {
    const std::string given = text_or(item, "coordinate");
    return given.empty() && type.coordinates.size() == 1 ? type.coordinates[0].name : given;
  };
  const auto turns = [&](const std::string& name) {
    const scene::JointCoordinate* found = type.coordinate(name);
    return found != nullptr && !found->is_length();
  };
  const Value& forces = *v.find("forces");
  for (std::size_t i = 0; i < forces.items.size(); ++i) {
    const Value& f = forces.items[i];
    j.forces.push_back({coordinate(f),
                        f.find("stiffness")->number,
                        f.find("rest")->number,
                        f.find("damping")->number,
                        {},
                        {},
                        text_or(f, "name")});
    scene::JointForce& force = j.forces.back();
    force.effort = law_or_signal(*f.find("effort"), at + "/forces/" + std::to_string(i) + "/effort", force.signal);
    if (turns(j.forces.back().coordinate))
      warn_of_degrees(*f.find("rest"), at + "/forces/" + std::to_string(i) + "/rest");
  }
  const Value& drives = *v.find("drives");
  for (std::size_t i = 0; i < drives.items.size(); ++i) {
    const Value& d = drives.items[i];
    scene::JointDrive drive{coordinate(d), d.find("rate")->truth, {}, {}};
    drive.law = law_or_signal(*d.find("law"), at + "/drives/" + std::to_string(i) + "/law", drive.signal);
    j.drives.push_back(std::move(drive));
    if (turns(j.drives.back().coordinate) && !j.drives.back().is_rate)
      warn_of_degrees(j.drives.back().law, at + "/drives/" + std::to_string(i) + "/law");
  }
  add(scene.joints, "joints", std::move(j), at);
}

/// A coupling whose ends are equal frames at the start may have a place of its own, as a joint has.
void Converter::coupling(const scene::CouplingKind& kind, const Value& v, const std::string& at) {
  scene::Coupling c;
  c.kind = &kind;
  c.name = v.find("name")->text;
  Side first = side(*v.find("first"), at + "/first"), second = side(*v.find("second"), at + "/second");
  if (kind.start == scene::CouplingStart::frame) {
    place_sides(v, at, scene::type_of(scene::JointKind::fixed), first, second);
    if (!first.has_rotation && poses_->of(std::string_view(first.to.to)))
      first.to.offset.R = scene::Mat3::identity();  // its own axes, not the second's
  }
  c.first = first.to;
  c.second = second.to;
  const auto add_numbers = [&c](const auto& from) {
    c.values.insert(c.values.end(), std::begin(from), std::end(from));
  };
  for (const scene::CouplingField& field : kind.fields) {
    const Value* given = v.find(field.name);  // there, if it is required or has a default in the schema
    switch (field.type) {
      case scene::CouplingFieldType::number: {
        const auto a = poses_->of(c.first), b = poses_->of(c.second);
        c.values.push_back(given != nullptr ? given->number : a && b ? norm(b->x - a->x) : 0.0);
        break;
      }
      case scene::CouplingFieldType::direction:
      case scene::CouplingFieldType::axis:
        add_numbers(vector(*given).v);
        break;
      case scene::CouplingFieldType::matrix:
        add_numbers((given != nullptr ? matrix6(*given) : scene::Mat6::zero()).m);
        break;
      case scene::CouplingFieldType::law: {
        scene::Factor& factor = c.factors.emplace_back();
        if (given != nullptr) factor.law = law_or_signal(*given, at + "/" + field.name, factor.signal);
      }
    }
  }
  if (kind.acts_along_line)
    for (const char* key : {"rest_law", "stiffness_factor", "force_law"})
      if (v.find(key) != nullptr) return driven_spring(v, at, c);
  add(scene.couplings, "couplings", std::move(c), at);
}

}  // namespace bough::io
