#include <algorithm>
#include <cmath>

#include "bough/motion/se3.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

/// Smallest pivot of L D L^T after scaling to a unit diagonal, with its row; a matrix of zeros on a zero diagonal row
/// counts as semi-definite.
struct Pivot {
  double value = 1.0;
  int row = -1;
  bool off_diagonal_of_zero = false;
};

Pivot smallest_pivot(const Mat6& a) {
  Mat6 m = a;
  Pivot smallest;
  double scale[6];
  for (int i = 0; i < 6; ++i) scale[i] = a(i, i) > 0.0 ? 1.0 / std::sqrt(a(i, i)) : 0.0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      if ((scale[i] == 0.0 || scale[j] == 0.0) && a(i, j) != 0.0 && i != j) smallest.off_diagonal_of_zero = true;
      m(i, j) = a(i, j) * scale[i] * scale[j];
    }
  for (int k = 0; k < 6; ++k) {
    const double pivot = m(k, k);
    if (pivot < smallest.value) smallest = {pivot, k, smallest.off_diagonal_of_zero};
    if (!(pivot >
          1e-12)) {  // nothing left of this direction: what still couples with it shows as an indefinite remainder
      for (int j = k + 1; j < 6; ++j)
        if (std::abs(m(k, j)) > 1e-6) smallest.off_diagonal_of_zero = true;
      continue;
    }
    for (int i = k + 1; i < 6; ++i)
      for (int j = k + 1; j < 6; ++j) m(i, j) -= m(i, k) * m(k, j) / pivot;
  }
  return smallest;
}

/// Principal values of a symmetric 3x3 matrix, in increasing order, by Jacobi rotations.
Vec3 principal_values(Mat3 a) {
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0.0;
    for (int p = 0; p < 3; ++p)
      for (int q = p + 1; q < 3; ++q) {
        off += std::abs(a(p, q));
        if (std::abs(a(p, q)) < 1e-18) continue;  // entries are at most 1 in size: below round-off
        const double theta = 0.5 * (a(q, q) - a(p, p)) / a(p, q);
        const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        Mat3 g = Mat3::identity();
        g(p, p) = g(q, q) = c;
        g(p, q) = s;
        g(q, p) = -s;
        a = lanes::transpose_times(g, a) * g;
        a(p, q) = a(q, p) = 0.0;
      }
    if (off < 1e-17) break;
  }
  Vec3 r = {{a(0, 0), a(1, 1), a(2, 2)}};
  std::sort(r.v, r.v + 3);
  return r;
}

void check_body(ProblemList& list, std::size_t i) {
  const Body& b = list.scene.bodies[i];
  const Mat3& J = b.inertia;
  if (b.is_point_mass) {
    if (b.mass == 0.0) list.warn("bodies", i, "mass", "0", "a point mass of 0 does nothing");
    return;
  }
  double largest = 0.0;
  for (const double x : J.m) largest = std::max(largest, std::abs(x));
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < r; ++c)
      if (std::abs(J(r, c) - J(c, r)) > 1e-9 * largest)
        return list.add("bodies", i, "inertia", "", "an inertia matrix is symmetric");
  if (largest == 0.0) return;
  Mat3 scaled = J;
  for (double& x : scaled.m) x /= largest;
  const Vec3 p = principal_values(scaled);
  const std::string values = text_of(p[0] * largest) + ", " + text_of(p[1] * largest) + ", " + text_of(p[2] * largest);
  if (p[0] < -1e-9)
    list.add("bodies", i, "inertia", values, "principal moments of inertia are not negative");
  else if (p[0] + p[1] < p[2] * (1.0 - 1e-9))
    list.add("bodies", i, "inertia", values,
             "no body has these principal moments: the largest exceeds the sum of the others",
             "is it given about the centre of mass, in the body's axes?");
}

/// Relative rotations of the nodes of an element have to stay below half a turn, where their sense becomes ambiguous.
/// The solver refuses an element shortly before.
void check_turn_of_elements(ProblemList& list, std::size_t i, double length) {
  constexpr double most = 2.8;  // [rad], the angle whose cosine is -0.94
  const Beam& b = list.scene.beams[i];
  const bool is_straight = b.curve == BeamCurve::straight;
  const double turn = is_straight ? std::abs(b.twist) : norm(b.curvature) * length;
  if (!(turn > most * b.elements)) return;
  list.add("beams", i, "elements", b.name,
           "each element of this beam turns by " + text_of(turn / b.elements) + " rad from its start to its end",
           "more than " + text_of(most) + " rad cannot be computed: take at least " + text_of(std::ceil(turn / 1.5)) +
               " elements");
}

void check_beam_axis(ProblemList& list, std::size_t i) {
  const Beam& b = list.scene.beams[i];
  const double length = list.poses.length_of(b);
  const bool is_straight = b.curve == BeamCurve::straight;
  if (!(length > 1e-12 * list.size))
    return list.add("beams", i, is_straight ? "end" : "curve", "", "the beam has length 0");
  if (!is_straight && is_zero(b.tangent))
    return list.add("beams", i, "curve/tangent", "0, 0, 0", "a tangent has a length other than 0");
  const auto axis = list.poses.axis_of(b);
  if (!axis)
    return list.add("beams", i, "axis_2", "",
                    "axis_2 runs along the beam and can not tell where section axis 2 points");
  check_turn_of_elements(list, i, length);
  if (is_straight) return;
  const Vec3 tip = axis->at(1.0).x;
  const auto end = list.poses.of(b.end);
  if (!end) return;
  const Vec3 gap = tip - motion::transform(*end, b.end_offset.value_or(Vec3::zero()));
  if (norm(gap) > 1e-6 * length)
    list.add("beams", i, "end", b.end, "the curved axis ends " + text_of(norm(gap)) + " m away from this end",
             "it ends at (" + text_of(tip[0]) + ", " + text_of(tip[1]) + ", " + text_of(tip[2]) + ")");
}

}  // namespace

std::string definite_fault(const Mat6& a, Definite wanted) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      if (std::abs(a(i, j) - a(j, i)) > 1e-9 * std::sqrt(std::abs(a(i, i) * a(j, j))) + 1e-12 * std::abs(a(i, j)))
        return "is not symmetric (row " + std::to_string(i + 1) + ", column " + std::to_string(j + 1) + ")";
  for (int i = 0; i < 6; ++i)
    if (a(i, i) < 0.0 || (wanted == Definite::positive && a(i, i) == 0.0))
      return "entry " + std::to_string(i + 1) + " of the diagonal has to be " +
             (wanted == Definite::positive ? "above 0" : "at least 0");
  const Pivot pivot = smallest_pivot(a);
  if (wanted == Definite::positive && (pivot.value < 1e-12 || pivot.off_diagonal_of_zero))
    return "is not positive definite";
  if (wanted == Definite::semi && (pivot.value < -1e-9 || pivot.off_diagonal_of_zero))
    return "is not positive semi-definite";
  return "";
}

void check_sections(ProblemList& list) {
  for (std::size_t i = 0; i < list.scene.sections.size(); ++i) {
    const Section& s = list.scene.sections[i];
    if (const std::string fault = definite_fault(s.stiffness, Definite::positive); !fault.empty())
      list.add("sections", i, "stiffness", "", "the stiffness " + fault);
    if (const std::string fault = definite_fault(s.mass, Definite::semi); !fault.empty())
      list.add("sections", i, "mass", "", "the mass matrix " + fault);
    if (const std::string fault = definite_fault(s.damping, Definite::semi); !fault.empty())
      list.add("sections", i, "damping", "", "the damping " + fault);
  }
}

void check_bodies(ProblemList& list) {
  for (std::size_t i = 0; i < list.scene.bodies.size(); ++i) check_body(list, i);
}

void check_beams(ProblemList& list) {
  std::unordered_set<std::string> used;
  for (std::size_t i = 0; i < list.scene.beams.size(); ++i) {
    const Beam& b = list.scene.beams[i];
    used.insert(b.section);
    const bool has_section = list.check_reference("beams", i, "section", b.section, list.sections, "section");
    bool has_ends = list.check_place("beams", i, "start", b.start, false);
    has_ends = list.check_place("beams", i, "end", b.end, false) && has_ends;
    for (const auto& [key, end] : {std::pair<const char*, const std::string&>{"start", b.start}, {"end", b.end}})
      if (has_ends && !list.poses.find(end)) {
        list.add("beams", i, key, end, "a beam ends at a node or body, not at an inner node of a beam",
                 "split that beam there with a node");
        has_ends = false;
      }
    if (has_ends && !b.frame.empty() && b.frame != "ground")
      has_ends = list.check_reference("beams", i, "frame", b.frame, list.frames, "frame");
    if (has_ends) check_beam_axis(list, i);
    if (has_section && list.is_dynamic && is_zero(list.scene.sections[list.section_of.at(b.section)].mass.m))
      list.warn("beams", i, "section", b.section, "this section has no mass, and the analysis is dynamic");
  }
  if (!list.defective.empty()) return;  // a beam that was left out may use it
  for (std::size_t i = 0; i < list.scene.sections.size(); ++i)
    if (used.count(list.scene.sections[i].name) == 0)
      list.warn("sections", i, "name", list.scene.sections[i].name, "no beam uses this section");
}

}  // namespace bough::scene
