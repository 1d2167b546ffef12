#include "schema_parts.hpp"

namespace bough::io {

RuleRef made(Rule rule) { return std::make_shared<const Rule>(std::move(rule)); }

Rule object_of(Literal about, std::vector<Field> fields, Literal marker) {
  Rule r;
  r.form = Form::object;
  r.about = about;
  r.fields = std::move(fields);
  r.marker = marker;
  return r;
}

Rule object_of_kind(std::vector<std::string> kinds, Literal about, std::vector<Field> fields) {
  fields.insert(fields.begin(), need("kind", word_rule("", kinds), "Which of the forms this is."));
  Rule r = object_of(about, std::move(fields));
  r.kinds = std::move(kinds);
  return r;
}

namespace {

void add_vectors(RuleTable& t) {
  const RuleRef any = number_rule("");
  t.named["vector"] = array_rule("Three components.", any, 3, 3);
  t.named["matrix3"] = array_rule("Three rows of three.", array_rule("", any, 3, 3), 3, 3);
  t.named["matrix6"] = array_rule("Six rows of six, order (linear; angular).", array_rule("", any, 6, 6), 6, 6);
  t.named["diagonal6"] = array_rule("The diagonal of a 6x6 matrix; the rest is zero.", any, 6, 6);
  t.named["rotation"] = choice_rule(
      "Rotation that carries the axes of the surrounding frame into those of this one.",
      {made(object_of("About an axis by an angle, right-handed.",
                      {need("axis", named_rule("vector"), "Axis; its length does not matter, but is not 0."),
                       need("angle", any, "Angle [rad].")},
                      "axis")),
       made(object_of("Unit quaternion, scalar first.",
                      {need("quaternion", array_rule("", any, 4, 4),
                            "(w, x, y, z); it is normalised, and must be within 1e-3 of unit length.")},
                      "quaternion")),
       made(object_of("Rotation vector: axis times angle.", {need("rotation_vector", named_rule("vector"), "[rad].")},
                      "rotation_vector")),
       made(object_of("Two of the new axes in the surrounding frame; the third follows. The first named keeps its "
                      "direction, the other is "
                      "made perpendicular to it.",
                      {need("axes",
                            made(object_of("Two of the three.", {may("1", named_rule("vector"), "Axis 1."),
                                                                 may("2", named_rule("vector"), "Axis 2."),
                                                                 may("3", named_rule("vector"), "Axis 3.")})),
                            "Exactly two axes.")},
                      "axes"))});
}

void add_attachments(RuleTable& t) {
  t.named["attachment"] = choice_rule(
      "What something is fixed to: a name, or a name with a place on it.",
      {text_rule("A node, a body, an inner node of a beam (\"<beam>.<k>\"), a frame, or \"ground\"."),
       made(object_of("A place on a named thing.",
                      {need("to", text_rule(""),
                            "A node, a body, an inner node of a beam (\"<beam>.<k>\"), a frame, or \"ground\"."),
                       may("position", named_rule("vector"), "In the frame of that thing [m]. Default: its origin."),
                       may("rotation", named_rule("rotation"),
                           "Of the attached axes in the frame of that thing. Default: none.")}))});
  t.named["beam_end"] = choice_rule(
      "The node or body a beam ends at, with the place on it where the beam's axis ends.",
      {text_rule("A node or a body."),
       made(object_of(
           "A place on a node or body.",
           {need("to", text_rule(""), "A node or a body."),
            need("position", named_rule("vector"), "End of the beam's axis in the frame of that thing [m].")}))});
  t.named["axes"] = word_rule(
      "space: components in the ground's axes, fixed there (a dead load). body: in the axes of the thing itself, "
      "turning "
      "with it (a follower).",
      {"space", "body"});
}

RuleRef file_name() { return text_rule(""); }

Rule with_points_or_file(Rule rule) {
  rule.exactly_one = {{"points", "file"}};
  return rule;
}

void add_section_parts(RuleTable& t) {
  t.named["pair"] = array_rule("Coordinates along axes 2 and 3 [m].", number_rule(""), 2, 2);
  t.named["section_shape"] = choice_rule(
      "Shape of a cross-section, its centroid on the axis. Torsion constants are those of Saint-Venant; shear factors, "
      "unless given, Cowper's for Poisson's ratio 0 (rectangle 5/6, circle 6/7, tube, ellipse); of thin-walled "
      "sections "
      "(box, i, c, l) both, and the shear centre, follow from the shear flow in their walls, warping is left out.",
      {made(object_of_kind(
           {"rectangle"}, "Solid rectangle.",
           {need("width", positive(""), "Along axis 2 [m]."), need("height", positive(""), "Along axis 3 [m].")})),
       made(object_of_kind({"circle"}, "Solid circle.", {need("radius", positive(""), "[m].")})),
       made(object_of_kind({"tube"}, "Circular tube.",
                           {need("outer_radius", positive(""), "[m]."),
                            need("inner_radius", positive(""), "[m], below the outer one.")})),
       made(object_of_kind({"ellipse"}, "Solid ellipse.",
                           {need("width", positive(""), "Whole axis along axis 2 [m]."),
                            need("height", positive(""), "Whole axis along axis 3 [m].")})),
       made(object_of_kind({"box"}, "Hollow rectangle with walls of one thickness.",
                           {need("width", positive(""), "Outside, along axis 2 [m]."),
                            need("height", positive(""), "Outside, along axis 3 [m]."),
                            need("thickness", positive(""), "Of the walls [m].")})),
       made(object_of_kind({"i", "c"},
                           "i: two flanges along axis 2, joined by a web along axis 3. c: the same with the web at the "
                           "lower end of axis 2.",
                           {need("width", positive(""), "Of the flanges, along axis 2 [m]."),
                            need("height", positive(""), "Of the whole, along axis 3 [m]."),
                            need("web", positive(""), "Thickness of the web [m]."),
                            need("flange", positive(""), "Thickness of the flanges [m].")})),
       made(object_of_kind({"l"}, "Two legs along the positive axes 2 and 3 from their corner.",
                           {need("width", positive(""), "Of the leg along axis 2 [m]."),
                            need("height", positive(""), "Of the leg along axis 3 [m]."),
                            need("thickness", positive(""), "Of both legs [m].")})),
       made(with_points_or_file(object_of_kind(
           {"polygon"},
           "Any outline; area and second moments are exact, torsion and shear have to be given. The section needs "
           "shear_factors.",
           {may("points", array_rule("", named_rule("pair"), 3, 500),
                "Corners along axes 2 and 3, counter-clockwise, the last one joined to the first [m]. The axis of the "
                "beam runs through the centroid."),
            may("file", file_name(),
                "Corners from a file below the folder of the scene: two numbers a line [m], an empty line before each "
                "hole."),
            may("holes", array_rule("", array_rule("", named_rule("pair"), 3, 500)), "Corners of holes, clockwise.",
                "[]"),
            may("torsion_constant", positive(""),
                "J of Saint-Venant [m^4]; needed where stiffness follows from the shape."),
            may("shear_center", named_rule("pair"), "From the centroid, along axes 2 and 3 [m].", "[0, 0]")})))});
  t.named["section_stiffness"] = choice_rule(
      "Section stiffness in the order (N, Q2, Q3, T, M2, M3) [N, N m, N m^2]; symmetric, positive definite.",
      {named_rule("diagonal6"), named_rule("matrix6"),
       made(object_of(
           "Diagonal by name.",
           {need("EA", positive(""), "Axial [N]."), need("GA2", positive(""), "Shear along axis 2 [N]."),
            need("GA3", positive(""), "Shear along axis 3 [N]."), need("GJ", positive(""), "Torsion [N m^2]."),
            need("EI2", positive(""), "Bending about axis 2 [N m^2]."),
            need("EI3", positive(""), "Bending about axis 3 [N m^2].")}))});
  t.named["section_mass"] = choice_rule(
      "Mass per length of a section; symmetric, positive semi-definite.",
      {named_rule("diagonal6"), named_rule("matrix6"),
       made(object_of(
           "By name.",
           {need("mass_per_length", not_negative(""), "[kg/m]."),
            may("rotary", array_rule("", not_negative(""), 3, 3),
                "Rotary inertia per length about axes 1, 2, 3 through the centre of mass [kg m].", "[0, 0, 0]"),
            may("center", named_rule("vector"), "Centre of mass in section axes [m].", "[0, 0, 0]")}))});
  t.named["section_damping"] =
      choice_rule("Viscous stiffness of strain rates.",
                  {named_rule("diagonal6"), named_rule("matrix6"),
                   made(object_of("Proportional to the stiffness.",
                                  {need("time", not_negative(""), "tau: damping = tau times stiffness [s].")}))});
}

void add_body_parts(RuleTable& t) {
  const RuleRef axis = integer_rule("", 1, 3);
  t.named["inertia"] =
      choice_rule("Inertia about the centre of mass in the body's axes [kg m^2].",
                  {array_rule("Principal values for axes 1, 2, 3.", not_negative(""), 3, 3), named_rule("matrix3")});
  t.named["body_shape"] = choice_rule(
      "Shape of a homogeneous body, centred on its centre of mass.",
      {made(object_of_kind({"box"}, "Cuboid.",
                           {need("size", array_rule("", positive(""), 3, 3), "Edges along axes 1, 2, 3 [m].")})),
       made(object_of_kind({"cylinder"}, "Solid circular cylinder.",
                           {need("radius", positive(""), "[m]."), need("length", positive(""), "[m]."),
                            may("axis", axis, "1, 2 or 3.", "1")})),
       made(object_of_kind({"sphere"}, "Solid sphere.", {need("radius", positive(""), "[m].")})),
       made(object_of_kind({"rod"}, "Slender rod; no inertia about its own axis.",
                           {need("length", positive(""), "[m]."), may("axis", axis, "1, 2 or 3.", "1")})),
       made(object_of_kind({"capsule"}, "Cylinder closed by two half spheres.",
                           {need("radius", positive(""), "[m]."),
                            need("length", positive(""), "Of the cylinder, without the half spheres [m]."),
                            may("axis", axis, "1, 2 or 3.", "1")})),
       made(object_of_kind({"cone"}, "Cone, or a part of one.",
                           {need("radius", positive(""), "At the lower end of the axis [m]."),
                            may("end_radius", not_negative(""), "At the upper end [m].", "0"),
                            need("length", positive(""), "[m]."), may("axis", axis, "1, 2 or 3.", "1")})),
       made(object_of_kind(
           {"ring"}, "Hollow cylinder.",
           {need("outer_radius", positive(""), "[m]."), need("inner_radius", positive(""), "[m], below the outer one."),
            need("length", positive(""), "[m]."), may("axis", axis, "1, 2 or 3.", "1")})),
       made(with_points_or_file(object_of_kind(
           {"extrusion"}, "A polygon drawn along an axis.",
           {may("points", array_rule("", named_rule("pair"), 3, 500),
                "Corners in the two axes after `axis`, counter-clockwise [m]; the centroid becomes the "
                "centre of mass."),
            may("file", file_name(), "Corners from a file below the folder of the scene, two numbers a line [m]."),
            need("length", positive(""), "[m]."), may("axis", axis, "1, 2 or 3.", "1")})))});
  t.named["body_looks"] = made(object_of(
      "A surface for pictures; nothing is computed from it.",
      {need("file", file_name(),
            "STL or OBJ below the folder of the scene, in the axes of the body's frame, at most 100 000 triangles."),
       may("scale", positive(""), "Times what the file says, for [m]: 0.001 of millimetres.", "1")}));
}

}  // namespace

void add_part_rules(RuleTable& table) {
  add_vectors(table);
  add_attachments(table);
  add_section_parts(table);
  add_body_parts(table);
}

}  // namespace bough::io
