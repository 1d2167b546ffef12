#include "mode_branches.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"

namespace bough::run {

namespace {

using Shape = std::vector<std::complex<double>>;
using Part = step::Linearisation::Part;

constexpr double much_alike = 0.6;    ///< MAC below which a continuation is doubted
constexpr double least_alike = 0.05;  ///< MAC below which a branch ends
constexpr double one_pair = 1e-4;     ///< relative distance of eigenvalues whose shapes may be any combination

/// M x of a complex shape.
Shape mass_times(const step::Linearisation& linear, const Shape& x) {
  std::vector<double> re(x.size()), im(x.size()), a(x.size()), b(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    re[i] = linear.is_multiplier(i) ? 0.0 : x[i].real();
    im[i] = linear.is_multiplier(i) ? 0.0 : x[i].imag();
  }
  linear.multiply(Part::mass, re, a);
  linear.multiply(Part::mass, im, b);
  Shape y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = {a[i], b[i]};
  return y;
}

std::complex<double> hermitian_product(const Shape& x, const Shape& y) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += std::conj(x[i]) * y[i];
  return sum;
}

}  // namespace

std::string ModeBranches::add(const step::Linearisation& linear, std::vector<step::Mode> modes,
                              const std::function<std::string(const step::Mode&)>& describe) {
  std::erase_if(modes, [](const step::Mode& mode) { return mode.is_rigid; });
  if (!shapes_.empty() && shapes_.front().size() != linear.size())
    return "the plan has " + std::to_string(linear.size()) + " unknowns, and " +
           std::to_string(shapes_.front().size()) +
           " with the value before: modes of another structure cannot be followed";
  std::vector<Shape> weighed;
  std::vector<double> sizes;
  for (const step::Mode& mode : modes) {
    weighed.push_back(mass_times(linear, mode.shape));
    sizes.push_back(std::abs(hermitian_product(mode.shape, weighed.back())));
  }
  struct Match {
    double score = 0.0, mac = 0.0;
    std::size_t branch = 0, mode = 0;
  };
  std::vector<Match> matches;
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const Branch& branch = branches_[b];
    if (branch.back().at + 1 != num_values_) continue;  // it has ended
    const double own = std::abs(hermitian_product(shapes_[b], mass_times(linear, shapes_[b])));
    const std::complex<double> last = branch.back().eigenvalue,
                               foretold = branch.size() > 1 ? 2.0 * last - branch[branch.size() - 2].eigenvalue : last;
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const double product = std::norm(hermitian_product(shapes_[b], weighed[m]));
      const double mac = own * sizes[m] > 0.0 ? product / (own * sizes[m]) : 0.0;
      const double away = std::abs(modes[m].eigenvalue - foretold) / (0.1 * std::abs(foretold) + 1e-12);
      if (mac > least_alike) matches.push_back({mac / (1.0 + away * away), mac, b, m});
    }
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Match& a, const Match& b) { return a.score > b.score; });
  std::vector<char> is_taken(modes.size(), 0), is_continued(branches_.size(), 0);
  const auto point_of = [&](std::size_t m, double mac) {
    return Point{num_values_, modes[m].eigenvalue, mac, modes[m].residual, describe(modes[m])};
  };
  for (const Match& match : matches) {
    if (is_taken[match.mode] != 0 || is_continued[match.branch] != 0) continue;
    is_taken[match.mode] = is_continued[match.branch] = 1;
    branches_[match.branch].push_back(point_of(match.mode, match.mac));
    shapes_[match.branch] = modes[match.mode].shape;
  }
  for (std::size_t m = 0; m < modes.size(); ++m) {
    if (is_taken[m] != 0) continue;
    branches_.push_back({point_of(m, 1.0)});
    shapes_.push_back(modes[m].shape);
  }
  ++num_values_;
  return {};
}

void ModeBranches::keep(std::size_t count) {
  std::vector<std::size_t> order(branches_.size());
  for (std::size_t b = 0; b < order.size(); ++b) order[b] = b;
  // Those that begin at the first value come first, by their frequency; then those that appear later.
  std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    const Point &p = branches_[a].front(), &q = branches_[b].front();
    return p.at != q.at ? p.at < q.at : std::abs(p.eigenvalue) < std::abs(q.eigenvalue);
  });
  std::vector<Branch> kept;
  std::size_t vibrations = 0;
  for (const std::size_t b : order) {
    if (vibrations >= count) {
      dropped_.push_back(std::move(branches_[b]));
      continue;
    }
    const bool vibrates =
        std::any_of(branches_[b].begin(), branches_[b].end(), [](const Point& p) { return p.eigenvalue.imag() > 0.0; });
    if (vibrates) ++vibrations;
    kept.push_back(std::move(branches_[b]));
  }
  branches_ = std::move(kept);
  shapes_.clear();
}

std::size_t ModeBranches::mirror_of(std::size_t branch, std::size_t at) const {
  constexpr double is_mirror = 1e-6;
  const auto point_at = [at](const Branch& of) {
    return std::find_if(of.begin(), of.end(), [at](const Point& p) { return p.at == at; });
  };
  const auto own = point_at(branches_[branch]);
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    if (b == branch || own == branches_[branch].end()) continue;
    if (const auto p = point_at(branches_[b]);
        p != branches_[b].end() &&
        std::abs(p->eigenvalue + std::conj(own->eigenvalue)) < is_mirror * std::abs(own->eigenvalue))
      return b;
  }
  return branches_.size();
}

std::string ModeBranches::doubt(const std::vector<double>& values) const {
  std::string text;
  int count = 0;
  for (std::size_t b = 0; b < branches_.size(); ++b)
    for (std::size_t k = 1; k < branches_[b].size(); ++k) {
      const Point &p = branches_[b][k - 1], &q = branches_[b][k];
      if (q.likeness >= much_alike) continue;
      // Of equal frequencies any combination of shapes is one, and only the plane of both has to be continued.
      const auto is_of_pair = [&](const Point& of) {
        const auto has_equal = [&](const Branch& other) {
          return &other != &branches_[b] && std::any_of(other.begin(), other.end(), [&](const Point& r) {
            return r.at == of.at && std::abs(r.eigenvalue - of.eigenvalue) <= one_pair * std::abs(of.eigenvalue);
          });
        };
        return std::any_of(branches_.begin(), branches_.end(), has_equal) ||
               std::any_of(dropped_.begin(), dropped_.end(), has_equal);
      };
      if (is_of_pair(p) || is_of_pair(q)) continue;
      if (++count <= 3)
        text += (text.empty() ? "branch " : ", branch ") + std::to_string(b + 1) + " between " +
                io::rounded_text(values[p.at], 6) + " and " + io::rounded_text(values[q.at], 6) + " (MAC " +
                io::rounded_text(q.likeness, 2) + ")";
    }
  if (count == 0) return {};
  return "where modes change their shapes by much from one value to the next it is not sure which continues which: " +
         text + (count > 3 ? " and " + std::to_string(count - 3) + " more" : "") + "; take more values there";
}

namespace {

/// The first of the four points, or as many as there are, next to a value.
std::size_t first_near(const ModeBranches::Branch& branch, const std::vector<double>& values, double value) {
  std::size_t k = 0;
  while (k + 1 < branch.size() && values[branch[k + 1].at] <= value) ++k;
  const std::size_t most = branch.size() > 4 ? branch.size() - 4 : 0;
  return std::min(k > 0 ? k - 1 : 0, most);
}

}  // namespace

std::complex<double> value_along(const ModeBranches::Branch& branch, const std::vector<double>& values, double value) {
  const std::size_t begin = first_near(branch, values, value), end = std::min(begin + 4, branch.size());
  std::complex<double> sum = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    double weight = 1.0;
    for (std::size_t j = begin; j < end; ++j)
      if (j != i) weight *= (value - values[branch[j].at]) / (values[branch[i].at] - values[branch[j].at]);
    sum += weight * branch[i].eigenvalue;
  }
  return sum;
}

ModeBranches::Branch combined(
    const ModeBranches::Branch& one, const ModeBranches::Branch& other,
    const std::function<std::complex<double>(std::complex<double>, std::complex<double>)>& f) {
  ModeBranches::Branch both;
  for (const ModeBranches::Point& p : one)
    for (const ModeBranches::Point& q : other)
      if (p.at == q.at) both.push_back({p.at, f(p.eigenvalue, q.eigenvalue), 1.0, 0.0, p.what});
  return both;
}

std::vector<double> zeros_along(const ModeBranches::Branch& branch, const std::vector<double>& values,
                                const std::function<double(std::complex<double>, double)>& quantity) {
  constexpr int halvings = 60;
  std::vector<double> zeros;
  for (std::size_t k = 1; k < branch.size(); ++k) {
    double low = values[branch[k - 1].at], high = values[branch[k].at];
    const bool begins = quantity(branch[k - 1].eigenvalue, low) < 0.0;
    if (begins == (quantity(branch[k].eigenvalue, high) < 0.0)) continue;
    for (int h = 0; h < halvings; ++h) {
      const double middle = 0.5 * (low + high);
      ((quantity(value_along(branch, values, middle), middle) < 0.0) == begins ? low : high) = middle;
    }
    zeros.push_back(0.5 * (low + high));
  }
  return zeros;
}

}  // namespace bough::run
