#include "mode_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bough/io/number_text.hpp"

namespace bough::run {

using motion::Vec3;
using motion::Vec6;

namespace {

using Vector = std::vector<double>;

Vector each_of(const step::Mode& mode, double (*part)(const std::complex<double>&)) {
  Vector x(mode.shape.size());
  std::transform(mode.shape.begin(), mode.shape.end(), x.begin(), part);
  return x;
}
Vector real_shape(const step::Mode& mode) {
  return each_of(mode, [](const std::complex<double>& z) { return z.real(); });
}
Vector imaginary_shape(const step::Mode& mode) {
  return each_of(mode, [](const std::complex<double>& z) { return z.imag(); });
}

double dot_of(const Vector& x, const Vector& y) { return std::inner_product(x.begin(), x.end(), y.begin(), 0.0); }
void take_away(double factor, const Vector& x, Vector& from) {
  for (std::size_t i = 0; i < x.size(); ++i) from[i] -= factor * x[i];
}

/// "(0, 0, 1)", its largest component positive.
std::string direction_text(Vec3<double> d) {
  d = (1.0 / length_of(d)) * d;
  int largest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(d[i]) > std::abs(d[largest]) + 1e-6) largest = i;
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const double part = std::abs(d[i]) < 5e-3 ? 0.0 : d[largest] < 0.0 ? -d[i] : d[i];
    text += (i == 0 ? "(" : ", ") + io::rounded_text(part, 2);
  }
  return text + ")";
}

}  // namespace

std::string text_of(const Shares& shares) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(most, shares.size()) && shares[k].second >= 0.01; ++k)
    text += (k > 0 ? ", '" : "'") + shares[k].first + "' " + io::rounded_text(std::round(100.0 * shares[k].second), 3) +
            " %";
  return text;
}

ModeParts::ModeParts(const step::Linearisation& linear, const step::State& state)
    : linear_(linear), plan_(linear.system().plan()), state_(state), nodes_(step::nodes_in_space(plan_, state)) {
  const auto set = [this](int direction, const Vec3<double>& about) {
    const auto k = static_cast<std::size_t>(direction);
    rigid_[k] = rigid_motion(direction, about);
    mass_times_rigid_[k].resize(linear_.size());
    linear_.multiply(Part::mass, rigid_[k], mass_times_rigid_[k]);
    moving_mass_[k] = dot_of(rigid_[k], mass_times_rigid_[k]);
  };
  for (int k = 0; k < 6; ++k) set(k, Vec3<double>::zero());
  Vec3<double> center = Vec3<double>::zero();  // velocities of the centre of mass by rotations about the origin
  for (int i = 0; i < 3; ++i) {
    const auto sideways = static_cast<std::size_t>((i + 1) % 3), turn = static_cast<std::size_t>(3 + (i + 2) % 3);
    if (moving_mass_[sideways] > 0.0)
      center[i] = dot_of(rigid_[turn], mass_times_rigid_[sideways]) / moving_mass_[sideways];
  }
  for (int k = 3; k < 6; ++k) set(k, center);
}

/// Unit translation or rotation in the axes of the ground, by unknown.
ModeParts::Vector ModeParts::rigid_motion(int direction, const Vec3<double>& about) const {
  Vector x(linear_.size(), 0.0);
  const Vec3<double> e = Vec3<double>::unit(direction % 3);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Vec3<double> arm = Vec3<double>(nodes_[n].x.hi + nodes_[n].x.lo) - about;
    const Vec3<double> u = direction < 3 ? e : lanes::cross(e, arm), w = direction < 3 ? Vec3<double>::zero() : e;
    linear_.system().places().set_node_part(
        x.data(), static_cast<int>(n),
        lanes::join(lanes::transpose_times(nodes_[n].R, u), lanes::transpose_times(nodes_[n].R, w)));
  }
  return x;
}

double ModeParts::form(Part part, const Vector& x, const Vector& y) const {
  double sum = 0.0;
  for (int e = 0; e < linear_.num_elements(); ++e) sum += linear_.form(part, e, x, y);
  return sum;
}

std::array<double, 6> ModeParts::participation(const step::Mode& mode) const {
  const Vector re = real_shape(mode), im = imaginary_shape(mode);
  std::array<double, 6> factors{};
  for (std::size_t k = 0; k < 6; ++k)
    factors[k] = std::hypot(dot_of(re, mass_times_rigid_[k]), dot_of(im, mass_times_rigid_[k]));
  return factors;
}

void ModeParts::normalise(step::Mode& mode) const {
  const Vector re = real_shape(mode), im = imaginary_shape(mode);
  const double mass = form(Part::mass, re, re) + form(Part::mass, im, im);
  if (!(mass > 0.0)) return;
  std::size_t most = 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < mode.shape.size(); ++i)
    if (const double size = linear_.weights()[i] * std::norm(mode.shape[i]); size > (1.0 + 1e-6) * largest) {
      largest = size;
      most = i;
    }
  const std::complex<double> phase = std::abs(mode.shape[most]) / mode.shape[most];
  for (std::complex<double>& value : mode.shape) value *= phase / std::sqrt(mass);
}

Shares ModeParts::shares(const step::Mode& mode, Part part) const {
  const Vector re = real_shape(mode), im = imaginary_shape(mode);
  std::map<std::string, double> by_part;
  double sum = 0.0;
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    const int id = static_cast<int>(e);
    const double energy = linear_.form(part, id, re, re) + linear_.form(part, id, im, im);
    by_part[plan_.element_owner[e]] += energy;
    sum += energy;
  }
  Shares list;
  if (!(sum > 0.0)) return list;
  for (const auto& [name, energy] : by_part) list.emplace_back(name, energy / sum);
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return list;
}

/// (displacement; rotation) in the axes of the ground.
Vec6<double> ModeParts::in_ground(const Vector& x, int node) const {
  const Vec6<double> eta = linear_.system().places().node_part(x.data(), node);
  const motion::Mat3<double>& R = nodes_[static_cast<std::size_t>(node)].R;
  return lanes::join(R * lanes::linear_part(eta), R * lanes::angular_part(eta));
}

/// How a beam moves, by the largest share of its kinetic energy: along its axis, sideways or about its axis.
std::string ModeParts::verb_of_beam(const std::string& name, const Vector& x) const {
  constexpr double clear = 0.7;
  std::array<double, 3> energies{};  // of motion along, across and about the axis
  for (std::size_t id = 0; id < plan_.directory.size(); ++id) {
    if (plan_.element_owner[id] != name) continue;
    plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
      if constexpr (std::decay_t<decltype(e)>::role == elements::Role::beam)
        for (std::size_t k = 0; k < 3; ++k) {
          Vector only(x.size(), 0.0);
          for (const elements::Port& port : e.ports) {
            if (port.node == elements::ground) continue;
            const Vec6<double> eta = linear_.system().places().node_part(x.data(), port.node);
            const Vec3<double> axis{{port.offset.R(0, 0), port.offset.R(1, 0), port.offset.R(2, 0)}};
            const Vec3<double> u = lanes::linear_part(eta), w = lanes::angular_part(eta);
            const Vec3<double> along = lanes::dot(axis, u) * axis, about = lanes::dot(axis, w) * axis;
            const Vec3<double> none = Vec3<double>::zero();
            linear_.system().places().set_node_part(only.data(), port.node,
                                                    k == 0   ? lanes::join(along, none)
                                                    : k == 1 ? lanes::join(u - along, w - about)
                                                             : lanes::join(none, about));
          }
          energies[k] += linear_.form(Part::mass, static_cast<int>(id), only, only);
        }
    });
  }
  const double sum = energies[0] + energies[1] + energies[2];
  if (energies[0] > clear * sum) return "extends";
  if (energies[2] > clear * sum) return "twists";
  return energies[1] > clear * sum ? "bends" : "bends and twists";
}

/// Whether the nodes of a beam turn differently, or move apart along its axis, and not as a rigid link does.
bool ModeParts::deforms(const std::string& name, const Vector& x) const {
  constexpr double clearly = 0.1;
  for (const plan::BeamPlan& beam : plan_.beams) {
    if (beam.name != name) continue;
    const Vec6<double> first = in_ground(x, beam.nodes.front());
    const elements::NodeMotion& n = nodes_[static_cast<std::size_t>(beam.nodes.front())];
    double turned = length_of(lanes::angular_part(first)), turned_apart = 0.0, stretched = 0.0, moved = 0.0;
    for (const int node : beam.nodes) {
      const Vec6<double> here = in_ground(x, node);
      const Vec3<double> arm = motion::difference(nodes_[static_cast<std::size_t>(node)].x, n.x);
      const Vec3<double> apart = lanes::linear_part(here) - lanes::linear_part(first);
      const double distance = length_of(arm);
      turned = std::max(turned, length_of(lanes::angular_part(here)));
      turned_apart = std::max(turned_apart, length_of(lanes::angular_part(here) - lanes::angular_part(first)));
      moved = std::max(moved, length_of(lanes::linear_part(here)));
      if (distance > 0.0) stretched = std::max(stretched, std::abs(lanes::dot(apart, arm)) / distance);
    }
    return turned_apart > clearly * turned || stretched > clearly * moved;
  }
  return false;
}

std::string ModeParts::describe(const step::Mode& mode) const {
  const Shares moved = kinetic_shares(mode);
  if (moved.empty()) return "";
  const Vector re = real_shape(mode), im = imaginary_shape(mode);
  Vector amplitude(re.size());
  for (std::size_t i = 0; i < re.size(); ++i) amplitude[i] = std::abs(mode.shape[i]);
  const int node = linear_.largest_node(amplitude);
  if (node < 0) return "";
  const std::string& part = moved.front().first;
  const bool is_beam = std::any_of(plan_.beams.begin(), plan_.beams.end(),
                                   [&part](const plan::BeamPlan& beam) { return beam.name == part; });
  const std::string verb = is_beam && deforms(part, re) ? verb_of_beam(part, re) : "";
  const Vec6<double> a = in_ground(re, node), b = in_ground(im, node);
  const double arm = plan_.length_scale;
  const bool turns = length_of(lanes::linear_part(a)) + length_of(lanes::linear_part(b)) <
                     0.05 * arm * (length_of(lanes::angular_part(a)) + length_of(lanes::angular_part(b)));
  const Vec3<double> cosine = turns ? lanes::angular_part(a) : lanes::linear_part(a),
                     sine = turns ? lanes::angular_part(b) : lanes::linear_part(b);
  const std::string text = "'" + part + "' ";
  // The motion a cos(t) - b sin(t) of a point goes around a x (-b).
  const Vec3<double> around = lanes::cross(sine, cosine);
  if (length_of(around) > 0.1 * (lanes::dot(cosine, cosine) + lanes::dot(sine, sine))) {
    const elements::NodeMotion& n = nodes_[static_cast<std::size_t>(node)];
    const double with_spin = lanes::dot(around, n.R * lanes::angular_part(n.v));
    return text +
           (with_spin > 0.0   ? "whirls forward about "
            : with_spin < 0.0 ? "whirls backward about "
                              : "whirls about ") +
           direction_text(around);
  }
  const Vec3<double>& direction = length_of(cosine) >= length_of(sine) ? cosine : sine;
  const std::string word = !verb.empty() ? verb : turns ? "turns" : "moves";
  return text + word + (turns ? " about " : " along ") + direction_text(direction);
}

/// The joint in which a motion without resistance happens.
std::string ModeParts::name_of_joint_motion(const Vector& x) const {
  std::string found;
  double largest = 0.0;
  for (const plan::JointPlan& joint : plan_.joints)
    plan::with_element(plan_.elements, plan_.directory[static_cast<std::size_t>(joint.element)], [&](const auto& e) {
      Vec6<double> relative = Vec6<double>::zero();
      double sign = -1.0;
      for (const elements::Port& port : e.ports) {
        if (port.node != elements::ground) {
          const Vec6<double> eta = in_ground(x, port.node);
          const Vec3<double> arm = nodes_[static_cast<std::size_t>(port.node)].R * port.offset.x;
          const Vec3<double> w = lanes::angular_part(eta);
          relative += sign * lanes::join(lanes::linear_part(eta) + lanes::cross(w, arm), w);
        }
        sign = 1.0;
      }
      const double turn = length_of(lanes::angular_part(relative)),
                   slide = length_of(lanes::linear_part(relative)) / plan_.length_scale;
      if (std::max(turn, slide) <= (1.0 + 1e-6) * largest) return;
      largest = std::max(turn, slide);
      found = (turn >= slide ? "rotation of joint '" : "sliding of joint '") + joint.name + "'";
    });
  return found;
}

std::vector<std::string> ModeParts::name_rigid(std::vector<step::Mode>& rigid) const {
  static const std::array<const char*, 6> names{"translation x",    "translation y",    "translation z",
                                                "rotation about x", "rotation about y", "rotation about z"};
  constexpr double belongs = 1e-6, is_left = 1e-3;
  std::vector<Vector> given, chosen;
  std::vector<std::string> words;
  Vector product(linear_.size());
  const auto mass_product = [&](const Vector& x, const Vector& y) {
    linear_.multiply(Part::mass, x, product);
    return dot_of(product, y);
  };
  for (const step::Mode& mode : rigid) given.push_back(real_shape(mode));
  const auto add = [&](Vector x, double least) {  // what is left of it beside those chosen, if that is enough
    const double before = std::sqrt(std::max(0.0, mass_product(x, x)));
    for (const Vector& other : chosen) take_away(mass_product(other, x), other, x);
    const double after = std::sqrt(std::max(0.0, mass_product(x, x)));
    if (!(after > least * before)) return false;
    for (double& value : x) value /= after;
    chosen.push_back(std::move(x));
    return true;
  };
  for (std::size_t k = 0; k < 6 && chosen.size() < rigid.size(); ++k) {
    Vector outside = rigid_[k];
    for (const Vector& x : given) take_away(mass_product(x, rigid_[k]), x, outside);
    if (moving_mass_[k] > 0.0 && mass_product(outside, outside) < belongs * belongs * moving_mass_[k] &&
        add(rigid_[k], is_left))
      words.emplace_back(names[k]);
  }
  for (const Vector& x : given) {
    if (chosen.size() == rigid.size()) break;
    if (add(x, is_left)) words.push_back(name_of_joint_motion(chosen.back()));
  }
  words.resize(rigid.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) rigid[k].shape.assign(chosen[k].begin(), chosen[k].end());
  return words;
}

}  // namespace bough::run
