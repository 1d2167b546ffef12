#include <algorithm>
#include <cstring>
#include <deque>

#include "bough/elements/coupling_kinds.hpp"
#include "bough/scene/components.hpp"
#include "formats/result_format.hpp"
#include "schema_parts.hpp"

namespace bough::io {
namespace {

const RuleRef reference = text_rule("");
const RuleRef any_number = number_rule("");

Field name_field() {
  return need("name", name_rule("1 to 100 characters without '.', '/' and control characters; not \"ground\"."),
              "Its name.");
}

/// Names of the coordinates of all joints.
std::vector<std::string> coordinate_names() {
  std::vector<std::string> names;
  for (const scene::JointType& type : scene::joint_types())
    for (const scene::JointCoordinate& c : type.coordinates)
      if (std::find(names.begin(), names.end(), c.name) == names.end()) names.push_back(c.name);
  return names;
}
/// Rules refer to their texts and are never destroyed.
const std::string& lasting(std::string text) {
  static auto& texts = *new std::deque<std::string>;
  return texts.emplace_back(std::move(text));
}

RuleRef joint_kind_rule() {
  std::vector<std::string> names;
  std::string about;
  for (const scene::JointType& type : scene::joint_types()) {
    names.push_back(type.name);
    about += (about.empty() ? "" : " ") + type.name + ": " + type.about;
  }
  return word_rule(lasting(std::move(about)).c_str(), std::move(names));
}
Field factor_field(Literal about) { return may("law", named_rule("law_or_signal"), about, {}); }
Field frame_field(Literal about) { return may("frame", reference, about); }

void add_placement(std::vector<Field>& fields, Literal origin, Literal rotation) {
  fields.push_back(may("position", named_rule("vector"), origin, "[0, 0, 0]"));
  fields.push_back(may("rotation", named_rule("rotation"), rotation));
  fields.push_back(frame_field("Frame in which position and rotation are given, at the start. Default: the ground."));
}

void add_properties(RuleTable& t) {
  t.named["frame"] = made(object_of(
      "A frame, posed in the ground or in another frame; fixed there, or moving by laws of time:  x = position(t), "
      "R = rotation exp(angle_1(t) axis_1) exp(angle_2(t) axis_2) ... What names a moving frame as its `frame` is "
      "placed in it "
      "at the start and then goes its own way; what a joint, spring or bushing fixes to it is carried along.",
      {name_field(), may("position", named_rule("three_laws"), "Of the origin in `frame` [m].", "[0, 0, 0]"),
       may("rotation", named_rule("rotation"), "Of the axes in `frame` where all turns are zero. Default: none."),
       may("turns", array_rule("", named_rule("turn")), "Rotations that follow, one after the other.", "[]"),
       frame_field("The frame it stands in. Default: the ground.")}));

  Rule material =
      object_of("An isotropic elastic material.",
                {name_field(), need("young", positive(""), "Young's modulus E [Pa]."),
                 may("shear", positive(""), "Shear modulus G [Pa]."),
                 may("poisson", number_rule("", -1.0, true, 0.5), "Poisson's ratio [-]; G = E / (2 (1 + nu))."),
                 may("density", not_negative(""), "[kg/m^3].", "0")});
  material.exactly_one = {{"shear", "poisson"}};
  t.named["material"] = made(std::move(material));

  Rule shaped = object_of(
      "A section of given shape and material.",
      {name_field(), need("shape", named_rule("section_shape"), "Shape of the cross-section."),
       need("material", reference, "Name of its material."),
       may("shear_factors", array_rule("", positive(""), 2, 2), "Shear correction factors for axes 2 and 3 [-]."),
       may("damping", named_rule("section_damping"), "Viscous damping. Default: none.")},
      "shape");
  Rule given = object_of("A section of given stiffness and mass.",
                         {name_field(), need("stiffness", named_rule("section_stiffness"), "Section stiffness."),
                          may("mass", named_rule("section_mass"), "Mass per length. Default: none (statics)."),
                          may("outline", named_rule("section_shape"), "For pictures; nothing is computed from it."),
                          may("damping", named_rule("section_damping"), "Viscous damping. Default: none.")},
                         "stiffness");
  t.named["section"] = choice_rule(
      "Cross-section of beams, about the beam's axis; axis 1 along the beam, resultants (N, Q2, Q3, T, M2, M3).",
      {made(std::move(shaped)), made(std::move(given))});
}

void add_parts(RuleTable& t) {
  Rule node = object_of("A node: a frame that moves.", {name_field()});
  add_placement(node.fields, "Origin of the node in `frame` [m].", "Rotation of the node in `frame`. Default: none.");
  t.named["node"] = made(std::move(node));

  Rule body = object_of(
      "A rigid body or a point mass. Its frame is also a node of the same name. A rigid body takes inertia or shape; a "
      "point mass neither.",
      {name_field(), may("kind", word_rule("", {"rigid", "point_mass"}), "Rigid body or point mass.", "\"rigid\""),
       may("mass", not_negative(""), "[kg]; may be left out where density or material say it."),
       may("inertia", named_rule("inertia"), "About the centre of mass, in the body's axes."),
       may("shape", named_rule("body_shape"), "Shape that the inertia follows from."),
       may("looks", named_rule("body_looks"), "Surface that pictures show in the place of the shape."),
       may("density", positive(""), "With a shape [kg/m^3]."),
       may("material", reference, "Material whose density a shape takes."),
       may("center_of_mass", named_rule("vector"), "In the body's frame [m].", "[0, 0, 0]")});
  add_placement(body.fields, "Origin of the body's frame in `frame` [m].",
                "Rotation of the body's frame in `frame`. Default: none.");
  body.at_most_one = {{"inertia", "shape"}, {"mass", "density", "material"}};
  t.named["body"] = made(std::move(body));

  t.named["curve"] = made(object_of(
      "Axis of constant curvature: a circle or a helix.",
      {need("curvature", named_rule("vector"),
            "Body components (k1, k2, k3) of the curvature vector: twist rate, bending about axes 2 and 3 [1/m]."),
       need("length", positive(""), "Length of the axis [m]."),
       need("tangent", named_rule("vector"), "Axis 1 at the start, in `frame`.")}));
  t.named["beam"] = made(object_of(
      "A beam between two nodes or bodies. Its inner nodes are named \"<beam>.<k>\", k = 0 at the start.",
      {name_field(), need("section", reference, "Name of its section."),
       need("start", named_rule("beam_end"), "Where it starts."), need("end", named_rule("beam_end"), "Where it ends."),
       may("axis_2", named_rule("vector"),
           "Vector in `frame`, to which section axis 2 at the start lies nearest. Default: chosen; any "
           "section with equal properties in both directions may leave it out."),
       frame_field("Frame of axis_2 and of the curve's tangent, at the start. Default: the ground."),
       may("twist", any_number, "Rotation of the section about axis 1 from start to end of a straight beam [rad].",
           "0"),
       may("curve", named_rule("curve"), "Default: straight."),
       may("elements", integer_rule("", 1, 1e6),
           "Number of finite elements. Default: as many as have twelve nodes beside the first, 24 if the axis is "
           "curved, "
           "which is told."),
       may("order", integer_rule("", 1, 3),
           "Polynomial order of the elements: 1 (two nodes), 2 or 3. Default: 3 without `elements`, else 1.")}));
}

void add_joints(RuleTable& t) {
  const RuleRef coordinate = word_rule("", coordinate_names());
  const Literal which = "Which coordinate; may be left out where the joint has only one.";
  const RuleRef force = made(
      object_of("A spring, damper or effort along a free coordinate of the joint.",
                {may("coordinate", coordinate, which), may("stiffness", not_negative(""), "[N m/rad] or [N/m].", "0"),
                 may("rest", any_number, "Coordinate at which the spring is free [rad] or [m].", "0"),
                 may("damping", not_negative(""), "[N m s/rad] or [N s/m].", "0"),
                 may("effort", named_rule("law_or_signal"),
                     "Torque [N m] or force [N] on the second about or along the axis.", "0"),
                 may("name", text_rule(""), "By which signals and sensors of kind \"joint_effort\" read it alone.")}));
  const RuleRef drive =
      made(object_of("Prescribes a coordinate of the joint: the second relative to the first.",
                     {may("coordinate", coordinate, which),
                      need("law", named_rule("law_or_signal"), "Value [rad] or [m]; with rate [rad/s] or [m/s]."),
                      may("rate", boolean_rule(""),
                          "The law is the rate; it is integrated exactly from the initial value.", "false")}));
  t.named["joint"] = made(object_of(
      "A joint between two things. Its reaction is the wrench of the first on the second, at the "
      "second's joint frame. A coordinate is the motion of the second relative to the first.",
      {name_field(), need("kind", joint_kind_rule(), "What it leaves free."),
       need("first", named_rule("attachment"),
            "What it joins. A bare name takes the place the other one, or `position`, says."),
       need("second", named_rule("attachment"), "What it joins to the first."),
       may("position", named_rule("vector"),
           "Place of the joint at the start, in `frame` [m]. Default: from the attachments; with two bare names their "
           "common origin, and where one of them is the ground the origin of the other: a body hinged there turns "
           "about "
           "its own origin."),
       may("axis", named_rule("vector"),
           "Axis 3 of the joint's frames at the start, in `frame` (universal: axis 1, fixed in the first)."),
       may("second_axis", named_rule("vector"),
           "Universal: the axis fixed in the second. Others: direction from which the angle is counted "
           "(axis 1 of the joint)."),
       frame_field("Frame of position and axes, at the start. Default: the ground."),
       may("pitch", any_number, "Screw: displacement per turn [m]."),
       may("forces", array_rule("", force, 0, 4), "Springs, dampers and efforts along its coordinates.", "[]"),
       may("drives", array_rule("", drive), "Prescribed coordinates.", "[]")}));

  t.named["actuator"] = made(object_of_kind(
      {"servo"},
      "A servo along a free coordinate q of a joint: lag T' + T = limited(position_gain (target - q) + rate_gain "
      "(target_rate - q')), T its torque or force on the second. What it is told is limited before the lag, so that T "
      "stays within the limit and leaves it as soon as the sum of gains does. In statics T is that sum, limited.",
      {need("name", name_rule("A word of formulas: a letter or _, then letters, digits and _."),
            "Its name, which is that of the signal T too."),
       need("joint", reference, "The joint; a strut for one between two points."), may("coordinate", coordinate, which),
       may("target", named_rule("law_or_signal"), "Wanted coordinate [rad] or [m].", "0"),
       may("target_rate", named_rule("law_or_signal"),
           "Wanted rate [rad/s] or [m/s]. Default: that of the target, of signals as far as it follows."),
       may("position_gain", not_negative(""), "[N m/rad] or [N/m].", "0"),
       may("rate_gain", not_negative(""), "[N m s/rad] or [N s/m].", "0"),
       may("limit", positive(""), "Largest torque [N m] or force [N]. Default: none."),
       may("lag", positive(""), "Time constant [s]. Default: none; the effort then follows at once."),
       may("start", any_number, "T at the start of dynamics [N m] or [N]; within the limit.", "0")}));
}

/// What a kind of couplings takes of a field: its rule, what follows its sentence, and whether it may be left out.
Field coupling_field(const scene::CouplingField& field) {
  using Type = scene::CouplingFieldType;
  const std::string unit = std::string(" [") + field.unit + "]";
  RuleRef rule = named_rule("vector");
  std::string more = ", in the ground at the start; the first carries it.";
  if (field.type == Type::number) {
    rule = number_rule("", field.low, field.is_low_open);
    more = unit + (field.starts_as_distance ? ". Default: the distance at the start." : ".");
  } else if (field.type == Type::matrix) {
    rule = choice_rule("", {named_rule("diagonal6"), named_rule("matrix6")});
    more = unit + ", order (linear; angular). Default: none.";
  } else if (field.type == Type::law) {
    rule = named_rule("law_or_signal");
    more = unit + ". Default: 1.";
  }
  const std::string& about =
      lasting(std::string(field.about, std::strlen(field.about) - 1) + more);  // a full stop less
  const bool is_optional =
      *field.standard != 0 || field.starts_as_distance || field.type == Type::matrix || field.type == Type::law;
  return is_optional ? may(field.name, rule, about.c_str(), field.standard) : need(field.name, rule, about.c_str());
}

/// What makes a strut of a coupling along a line.
void add_strut_fields(Rule& rule) {
  rule.fields.push_back(
      may("rest_law", named_rule("law_or_signal"),
          "Rest length that changes [m], in the place of rest_length. It is a strut of its name then."));
  rule.fields.push_back(may("stiffness_factor", named_rule("law_or_signal"),
                            "Factor of the stiffness that changes [-]. It is a strut of its name then. Default: 1."));
  rule.fields.push_back(
      may("force_law", named_rule("law"),
          "Tension [N] besides that of stiffness and damping: a law with the length [m] in the place of t, or a "
          "formula of `length`, `stretch` = length - rest_length [m], `rate` = d length/dt [m/s], signals and "
          "parameters, as in {\"expression\": \"k*stretch^3 + c*rate*abs(rate)\"}. What it has at rate 0 is stored as "
          "strain energy, unless it names signals. It is a strut of its name then. Default: none."));
  rule.at_most_one = {{"rest_length", "rest_law"}, {"force_law", "rest_law"}, {"force_law", "stiffness_factor"}};
}

/// The kinds of the catalogue, as their elements declare them; returns their lists.
std::vector<Field> add_catalogue(RuleTable& t) {
  std::vector<Field> lists;
  for (const scene::CouplingKind* kind : elements::coupling_kinds()) {
    std::vector<Field> fields = {name_field(), need("first", named_rule("attachment"), kind->first),
                                 need("second", named_rule("attachment"), kind->second)};
    if (kind->start == scene::CouplingStart::frame)
      fields.push_back(may("position", named_rule("vector"), "Place at the start, in the ground [m], as of a joint."));
    for (const scene::CouplingField& field : kind->fields) fields.push_back(coupling_field(field));
    Rule rule = object_of(kind->about, std::move(fields));
    if (kind->acts_along_line) add_strut_fields(rule);
    t.named[kind->name] = made(std::move(rule));
    lists.push_back(may(kind->list, array_rule("", named_rule(kind->name)), kind->about, "[]"));
  }
  return lists;
}

void add_loads(RuleTable& t) {
  const RuleRef free_name = name_rule("");
  const std::vector<Field> common = {may("name", free_name, "Its name. Default: numbered."),
                                     may("axes", named_rule("axes"), "Dead or follower.", "\"space\""),
                                     frame_field("Frame in whose axes a dead load is given, and with which it turns. "
                                                 "Default: the ground.")};
  std::vector<Field> point = common, line = common;
  point.push_back(need("at", named_rule("attachment"), "Where it acts."));
  point.push_back(may("force", named_rule("vector"), "[N].", "[0, 0, 0]"));
  point.push_back(may("moment", named_rule("vector"), "[N m]. A dead moment is a vector fixed in space.", "[0, 0, 0]"));
  point.push_back(
      factor_field("Factor over time (statics: over the load factor; default there: the load factor itself)."));
  line.push_back(need("beam", reference, "The beam it acts on."));
  line.push_back(may("force", named_rule("vector"), "Per reference length [N/m].", "[0, 0, 0]"));
  line.push_back(may("moment", named_rule("vector"), "Per reference length [N].", "[0, 0, 0]"));
  line.push_back(point.back());
  t.named["load"] =
      choice_rule("A force and moment, at a point or along a beam.",
                  {made(object_of("At a point.", point, "at")), made(object_of("Along a beam.", line, "beam"))});

  const RuleRef turning = choice_rule(
      "", {word_rule("The orientation is held.", {"hold"}),
           made(object_of("Rotation about a fixed axis of the ground from the initial orientation.",
                          {need("axis", named_rule("vector"), "In the ground."),
                           need("angle", named_rule("law_or_signal"), "[rad]; counts turns. With rate: [rad/s].")}))});
  t.named["motion"] = made(object_of(
      "Prescribed motion of a node or body from its initial pose. What is not given stays free.",
      {may("name", free_name, "Its name. Default: numbered."), need("at", named_rule("attachment"), "What moves."),
       may("x", named_rule("law_or_signal"), "Displacement along the ground's x [m]; with rate: velocity [m/s]."),
       may("y", named_rule("law_or_signal"), "The same along y."),
       may("z", named_rule("law_or_signal"), "The same along z."),
       may("rotation", turning, "Prescribed rotation. Default: free."),
       may("rate", boolean_rule(""), "The laws are rates, integrated exactly from the initial pose.", "false")}));
  t.named["initial_velocity"] = made(object_of(
      "Velocity at the start. What is not given, or zero, starts at rest, or as joints and drives demand; what they do "
      "not allow is changed, and told.",
      {need(
           "of", reference,
           "A node, a body, an inner node of a beam (\"<beam>.<k>\"), or a beam: then all its nodes, as a rigid motion "
           "about its start."),
       may("axes", named_rule("axes"), "Axes of the components.", "\"space\""),
       frame_field("Frame that it is relative to, whose own motion is added, and in whose axes space components are. "
                   "Default: the ground."),
       may("velocity", named_rule("vector"), "Of the frame's origin [m/s].", "[0, 0, 0]"),
       may("angular_velocity", named_rule("vector"),
           "[rad/s]. Default: 0; a point mass, or a node without beams, turns with what holds it.")}));
}

/// Formats that a scene may ask for.
RuleRef format_rule() {
  std::vector<std::string> names;
  std::string about;
  for (const ResultFormat& format : result_formats()) {
    if (format.name.empty()) continue;
    names.push_back(format.name);
    about += (about.empty() ? "" : "; ") + format.name + ": " + format.about;
  }
  return word_rule(lasting(about + ".").c_str(), std::move(names));
}

/// Fields of a sensor by what it is attached to, and those that its kind takes besides.
Rule sensor_rule(const scene::SensorType& type) {
  using scene::SensorField;
  using scene::SensorOf;
  const RuleRef station = number_rule("", 0.0, false, 1.0);
  std::vector<Field> fields = {name_field()};
  if (type.of == SensorOf::point) {
    fields.push_back(may("at", named_rule("attachment"), "The point."));
    fields.push_back(may("beam", reference, "A point of this beam's axis."));
    fields.push_back(may("station", station, "Fraction of the beam's length from its start [-]."));
  } else if (type.of == SensorOf::section) {
    fields.push_back(need("beam", reference, "The beam."));
    fields.push_back(need("station", station, "Fraction of its length from its start [-]."));
  } else if (type.of == SensorOf::beam) {
    fields.push_back(need("beam", reference, "The beam."));
  } else if (type.of == SensorOf::signal) {
    fields.push_back(need("signal", reference, "The signal."));
  } else if (type.of == SensorOf::subdomain) {
    fields.push_back(need("subdomain", text_rule(""),
                          "Its path in the tree of the solver: the number of the child at each level, as \"0.1\"."));
    fields.push_back(may("at", named_rule("attachment"),
                         "A node or body at its interface, or a point of it. Default: the resultant of all."));
  } else if (type.of == SensorOf::part) {
    fields.push_back(need("of", reference, "The prescribed motion, spring, bushing, other coupling or load."));
  } else if (type.of != SensorOf::whole) {
    fields.push_back(need("joint", reference, "The joint."));
  }
  if (type.takes(SensorField::axes))
    fields.push_back(may("axes", named_rule("axes"), "Axes of the components.", "\"space\""));
  if (type.takes(SensorField::chain))
    fields.push_back(need("frames", array_rule("", text_rule(""), 1, 100),
                          "The chain: frames, nodes or bodies; the point is seen from the last."));
  if (type.takes(SensorField::observer))
    fields.push_back(
        frame_field("Frame in whose axes it is given, and from which a motion is seen. Default: the ground."));
  if (type.takes(SensorField::axes_of))
    fields.push_back(frame_field("Frame, node or body in whose axes components are given. Default: the ground."));
  if (type.takes(SensorField::coordinate))
    fields.push_back(may("coordinate", word_rule("", coordinate_names()),
                         "Which one. Default: the only coordinate that the joint has; where it has several, one has to "
                         "be given."));
  if (type.takes(SensorField::effort_part)) fields.push_back(effort_part_field());
  if (type.takes(SensorField::resultant))
    fields.push_back(need("component", word_rule("", scene::components_of(scene::SensorKind::section_force)),
                          "Which section resultant, in section axes."));
  const std::string components = scene::components_text(type);
  const std::string& about = lasting(type.about + " Components: " + components + ".");
  Rule rule = object_of_kind({type.name}, about.c_str(), std::move(fields));
  if (type.of == SensorOf::point) rule.exactly_one = {{"at", "beam"}};
  return rule;
}

void add_sensors(RuleTable& t) {
  std::vector<RuleRef> kinds;
  for (const scene::SensorType& type : scene::sensor_types()) kinds.push_back(made(sensor_rule(type)));
  t.named["sensor"] = choice_rule(
      "A measured quantity, written over time. Its columns are \"<name>.<component>\", or \"<name>\" for scalars.",
      std::move(kinds));
}

void add_settings(RuleTable& t) {
  const Field frame = frame_field(
      "Frame in which everything is described: the ground, poses, velocities, dead loads and results are relative to "
      "it, and its inertial "
      "loads act. Static: it moves steadily, its laws are taken at time 0, its inertial loads grow with the load "
      "factor. Default: "
      "the inertial frame.");
  add_analysis_rules(t, frame);
  t.named["solver"] = made(object_of(
      "Linear solver. What is left out is chosen from the scene.",
      {may("form", word_rule("", scene::solver_form_names()),
           "Sub-domains condensed to their interfaces along a tree (local, the default); the same through the "
           "flexibilities of interfaces with a penalty (augmented), sub-domains torn apart and tied to each other "
           "(global), or some of their nodes kept on an interface mesh (hybrid), for comparison; or one factorization "
           "(monolithic)."),
       may("kind", word_rule("", {"automatic", "hierarchical", "global", "hybrid", "monolithic"}),
           "Former name of `form`: \"automatic\" and \"hierarchical\" are \"local\"."),
       may("library", word_rule("", {"klu", "sparse_lu", "umfpack", "cholmod"}),
           "Who factors the one matrix of form \"monolithic\". UMFPACK and CHOLMOD (symmetric only) are in "
           "programs built with BOUGH_WITH_GPL.",
           "\"klu\""),
       may("interface_solution", word_rule("", {"direct", "iterative"}),
           "Of the interface problem of forms \"global\" and \"hybrid\"; iterative for comparison only.", "\"direct\""),
       may("leaf_size", integer_rule("", 1, 1e6), "Elements in a sub-domain at the bottom. Default: chosen."),
       may("depth", integer_rule("", 0, 40), "Levels of the hierarchy. Default: chosen."),
       may("penalty_factor", positive(""),
           "Penalty of the form \"augmented\", times the interface's own stiffness [-]. Default: 1. Other forms have "
           "none."),
       may("tasks", boolean_rule(""), "Run as tasks on several threads.", "true"),
       may("threads", integer_rule("", 1, 1024),
           "That a case of a batch or sweep asks for; it gets no more than these have in all.", "1")}));
  t.named["output"] = made(object_of(
      "What is written.",
      {may("stride", integer_rule("", 1, 1e9), "History rows: every n-th step.", "1"),
       may("motion", boolean_rule(""), "Write the moving structure for pictures.", "false"),
       may("motion_stride", integer_rule("", 1, 1e9),
           "Pictures: every n-th step. Default: at most 101, evenly over the run, and further ones wherever a part has "
           "turned by a quarter of a radian; fewer where they would take more than 200 MB; of statics by arc length "
           "every step."),
       may("checks", boolean_rule(""), "Balances and constraint violations, at history rows.", "true"),
       may("checkpoint", number_rule("", 0.0, false),
           "Wall clock between two checkpoints [s], from which `bough run --resume` goes on; 0: there are none.",
           "300"),
       may("checkpoint_time", positive(""),
           "Further checkpoints after so much time of the run [s], or load factor. Default: none."),
       may("formats", array_rule("", format_rule()),
           "Files for other programs, besides those of every run; batches write them for cases that have folders.",
           "[]")}));
  t.named["expected"] = made(object_of(
      "A figure the run has to meet. It is taken from all accepted steps, whatever the stride of the output. A time "
      "within a "
      "step of equal size is interpolated there: places, rotations and velocities from poses and velocities at both "
      "ends of the "
      "step, all else by the cubic through the ends of four steps. Steps of controlled size and load steps end at the "
      "time. "
      "One of the tolerances at least is given.",
      {need("quantity", reference, "\"<sensor>.<component>\", or \"<sensor>\" for a scalar."),
       may("figure", word_rule("", {"value", "max", "min", "time_of_max", "time_of_min", "range", "period"}),
           "Value at a time or at the end; largest and smallest value of the run, the times at which they are met "
           "first "
           "[s] (statics: load factors), and what lies between them; mean time between upward crossings of `level` [s] "
           "(dynamics). Within steps in time extremes and crossings are interpolated, statics takes the ends of load "
           "steps.",
           "\"value\""),
       may("time", not_negative(""), "Of figure \"value\" [s] (statics: load factor). Default: at the end."),
       may("level", any_number, "Of figure \"period\": the value whose upward crossings are counted. Default: 0."),
       need("value", any_number, "What is expected."),
       may("tolerance", positive(""), "Largest difference, absolute; with relative_tolerance the two add up."),
       may("relative_tolerance", positive(""), "Largest difference as a part of |value| [-]."),
       may("source", text_rule(""), "Where the figure comes from.", "\"\"")}));
}

RuleTable make_scene_rules() {
  RuleTable t;
  add_part_rules(t);
  add_law_rules(t);
  add_signal_rules(t);
  add_properties(t);
  add_parts(t);
  add_joints(t);
  add_loads(t);
  add_sensors(t);
  add_measure_rules(t);
  add_settings(t);
  const auto list = [](Literal key, Literal item, Literal about) {
    return may(key, array_rule("", named_rule(item)), about, "[]");
  };
  std::vector<Field> lists = {list("frames", "frame", "Frames, fixed or moving."),
                              list("materials", "material", "Materials."),
                              list("sections", "section", "Beam sections."),
                              list("nodes", "node", "Nodes."),
                              list("bodies", "body", "Rigid bodies and point masses."),
                              list("beams", "beam", "Beams."),
                              list("joints", "joint", "Joints."),
                              list("actuators", "actuator", "Servos with a lag and a limit."),
                              list("loads", "load", "Loads."),
                              list("motions", "motion", "Prescribed motions."),
                              list("initial_velocities", "initial_velocity", "Velocities at the start."),
                              list("signals", "signal", "Numbers that change with the motion."),
                              list("sensors", "sensor", "What is measured."),
                              list("expected", "expected", "Figures the run has to meet."),
                              list("measures", "measure", "Figures of the run, columns of batches and sweeps.")};
  const std::vector<Field> couplings = add_catalogue(t);
  lists.insert(lists.begin() + 7, couplings.begin(), couplings.end());  // after joints
  add_expansion_rules(t, lists);
  t.has_formulas = true;
  Rule root = object_of(
      "A bough scene. SI units and radians throughout. Things are named and refer to each other by name: frames, "
      "nodes, bodies, beams, joints, springs, bushings, other couplings, loads and motions share one set of names; "
      "materials, sections, sensors and signals have their own. Axis 1 of a section runs along the beam; section "
      "resultants are "
      "(N, Q2, Q3, T, M2, M3). Quaternions have the scalar first. A reaction is the wrench "
      "of the first on the second, at the joint. A dead moment is a vector fixed in space; a follower turns with its "
      "node. A \"comment\" string is allowed in every object. null is never a value. {\"expression\": \"...\"} may "
      "stand "
      "for any number, of t only where a law of time stands. In scenes with `parameters` or `repeat`, braces in "
      "strings hold a "
      "formula for a whole number, {{ and }} are single braces.",
      {may("$schema", text_rule(""), "Address of this schema, for editors; not read."),
       need("schema_version", integer_rule("", 1, 1), "Version of the format: 1."),
       may("title", text_rule(""), "One line.", "\"\""),
       may("gravity",
           choice_rule("", {named_rule("vector"),
                            made(object_of("Gravity that changes by a factor.",
                                           {need("vector", named_rule("vector"), "[m/s^2], inertial."),
                                            may("law", named_rule("law_or_signal"), "Factor over time.", "1")},
                                           "vector")),
                            made(object_of("Gravity whose components change, made of weights of all bodies and beams.",
                                           {need("components", array_rule("", named_rule("law_or_signal"), 3, 3),
                                                 "Along the ground's x, y and z [m/s^2].")},
                                           "components"))}),
           "Acceleration of gravity [m/s^2], inertial.", "[0, 0, 0]"),
       need("analysis", named_rule("analysis"), "What is computed."),
       may("solver", named_rule("solver"), "Linear solver.", "{}"),
       may("output", named_rule("output"), "What is written.", "{}"),
       may("without", array_rule("", word_rule("", scene::names_in_without())),
           "Decisions that the plan is not to take (`bough plan` lists them), for comparison.", "[]"),
       may("parameters", named_rule("parameters"), "Named numbers of formulas."),
       may("repeat", named_rule("repeat"), "Parts that come many times.")});
  root.fields.insert(root.fields.begin() + 4, lists.begin(), lists.end());
  t.root = made(std::move(root));
  return t;
}

}  // namespace

const RuleTable& scene_rules() {
  static const RuleTable& table = *new RuleTable(make_scene_rules());  // never destroyed, since that takes long
  return table;
}

}  // namespace bough::io
