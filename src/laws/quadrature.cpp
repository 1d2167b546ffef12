#include "quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "bough/laws/make_law.hpp"

namespace bough::laws {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int max_depth = 48;
constexpr int max_halvings = 2000;
constexpr double given_up = 1e-6;  // relative error of a stretch, against int |f|, above which the integral is NaN

// Nodes in (0, 1), outermost first; the odd ones (and 0) are those of Gauss.
constexpr std::array<double, 7> node_x{0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                       0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                       0.586087235467691130294144838258730, 0.405845151377397166906606412076961,
                                       0.207784955007898467600689403773245};
constexpr std::array<double, 7> kronrod{0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                        0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                        0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                        0.204432940075298892414161999234649};
constexpr double kronrod_middle = 0.209482141084727828012999174891714;
constexpr std::array<double, 3> gauss{0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                                      0.381830050505118944950369775488975};
constexpr double gauss_middle = 0.417959183673469387755102040816327;

struct Estimate {
  double value;      ///< Kronrod sum
  double magnitude;  ///< of |f|
  double gap;        ///< |Kronrod - Gauss|, far above the error of Kronrod where f is smooth
  double error;      ///< QUADPACK's guess of the error of Kronrod
};

using Function = std::function<double(double)>;

Estimate eval_rule(const Function& f, double a, double b) {
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  const double f_middle = f(middle);
  double k = kronrod_middle * f_middle;
  double g = gauss_middle * f_middle;
  double magnitude = kronrod_middle * std::abs(f_middle);
  std::array<double, 14> values{};
  for (std::size_t i = 0; i < node_x.size(); ++i) {
    const double low = f(middle - half * node_x[i]);
    const double high = f(middle + half * node_x[i]);
    values[2 * i] = low;
    values[2 * i + 1] = high;
    k += kronrod[i] * (low + high);
    magnitude += kronrod[i] * (std::abs(low) + std::abs(high));
    if (i % 2 == 1) g += gauss[i / 2] * (low + high);
  }
  const double mean = 0.5 * k;
  double spread = kronrod_middle * std::abs(f_middle - mean);
  for (std::size_t i = 0; i < node_x.size(); ++i) {
    spread += kronrod[i] * (std::abs(values[2 * i] - mean) + std::abs(values[2 * i + 1] - mean));
  }
  const double width = std::abs(half);
  Estimate estimate{k * half, magnitude * width, std::abs(k - g) * width, 0.0};
  spread *= width;
  estimate.error = estimate.gap;
  if (spread > 0.0) estimate.error = spread * std::min(1.0, std::pow(200.0 * estimate.gap / spread, 1.5));
  return estimate;
}

struct Adaptive {
  const Function& f;
  double scale;      ///< first estimate of int |f|
  double tolerance;  ///< for the error of one stretch
  int halvings = 0;

  /// Sums from a to b, so the order of additions is fixed.
  double refine(double a, double b, const Estimate& whole, int depth) {
    const double middle = 0.5 * (a + b);
    const bool is_done = !(whole.error > tolerance) || !(whole.gap > 4.0 * eps * whole.magnitude);
    if (is_done) return whole.value;
    if (depth == max_depth || halvings == max_halvings || middle == a || middle == b) {
      return whole.error < given_up * scale ? whole.value : std::numeric_limits<double>::quiet_NaN();
    }
    ++halvings;
    const Estimate left = eval_rule(f, a, middle);
    const Estimate right = eval_rule(f, middle, b);
    // Halving a stretch where f is smooth shrinks the gap by orders of magnitude. If it does not, the gap consists of
    // round-off of f.
    const bool is_noise = whole.gap < 1e-9 * whole.magnitude && left.gap + right.gap > 0.5 * whole.gap;
    if (is_noise) return left.value + right.value;
    const double left_value = refine(a, middle, left, depth + 1);
    return left_value + refine(middle, b, right, depth + 1);
  }
};

/// Panel k >= 0 begins at first_width * begin_of(k) from t0. 4096 panels of one width, then 4096 of twice the width
/// and so on: fine near t0, where simulations are, and a number of panels that grows with the logarithm of |t - t0|.
constexpr double first_width = 1.0 / 64.0;
constexpr std::size_t panels_per_width = 4096;

double begin_of(std::size_t k) {
  const double scale = std::ldexp(1.0, static_cast<int>(k / panels_per_width));
  const double n = static_cast<double>(panels_per_width);
  return first_width * (n * (scale - 1.0) + scale * static_cast<double>(k % panels_per_width));
}

std::size_t panel_of(double distance) {
  const double n = static_cast<double>(panels_per_width);
  const int level = std::ilogb(distance / (first_width * n) + 1.0);
  const double scale = std::ldexp(1.0, level);
  const double within = (distance / first_width - n * (scale - 1.0)) / scale;
  auto k = static_cast<std::size_t>(level) * panels_per_width + static_cast<std::size_t>(std::max(0.0, within));
  while (k > 0 && begin_of(k) > distance) --k;
  while (begin_of(k + 1) <= distance) ++k;
  return k;
}

class QuadratureIntegral final : public Node {
 public:
  QuadratureIntegral(Law integrand, double t0) : integrand_(std::move(integrand)), t0_(t0) {}

  LawValue at(double t, Side side) const override {
    const LawValue f = integrand_.at(t, side);
    const double distance = std::abs(t - t0_);
    if (!(distance < max_distance)) return {std::numeric_limits<double>::quiet_NaN(), f.value, f.rate};
    const double direction = t < t0_ ? -1.0 : 1.0;
    const std::size_t k = panel_of(distance);
    std::size_t evaluations = 0;  // spent on a part of a panel
    const double before = sum_before(k, direction);
    const double value =
        std::isnan(before) ? before : before + integrate(t0_ + direction * begin_of(k), t, evaluations);
    return {value, f.value, f.rate};
  }
  void append_breaks(double t_begin, double t_end, int max_order, BreakList& breaks) const override {
    laws::append_breaks(integrand_, t_begin, t_end, max_order - 1, breaks);
  }
  Jet<Interval> range(double t_begin, double t_end) const override {
    const Jet<Interval> f = range_of(integrand_, t_begin, t_end);
    return {everything(), f.value, f.rate};
  }
  Law integral(double t0) const override {
    return make_quadrature_integral(Law{std::make_shared<QuadratureIntegral>(integrand_, t0_)}, t0);
  }
  std::optional<Law> integrand() const override { return integrand_; }

 private:
  static constexpr double max_distance = 1e15;  // [s]; beyond it the width of a panel is below the round-off of its
                                                // time

  /// Adds the number of evaluations to `evaluations`; NaN where it would exceed max_evaluations.
  double integrate(double a, double b, std::size_t& evaluations) const {
    if (a == b) return 0.0;
    Breaks breaks = sorted_breaks(integrand_, std::min(a, b), std::max(a, b), any_order, max_breaks);
    std::vector<double>& cuts = breaks.times;
    evaluations += static_cast<std::size_t>(breaks.work / 8.0) + cuts.size();
    if (breaks.is_cut) return std::numeric_limits<double>::quiet_NaN();
    if (b < a) std::reverse(cuts.begin(), cuts.end());
    cuts.push_back(b);
    const Function f = [this, &evaluations](double t) {
      ++evaluations;
      return integrand_.at(t).value;
    };
    double sum = 0.0;
    double from = a;
    for (double to : cuts) {
      if (to == from) continue;
      if (evaluations > max_evaluations) return std::numeric_limits<double>::quiet_NaN();
      sum += eval_quadrature(f, from, to);
      from = to;
    }
    return sum;
  }

  /// Sum of the panels before k on one side of t0, with the rounding of the additions carried along (Kahan).
  double sum_before(std::size_t k, double direction) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    Sums& sums = direction < 0.0 ? before_ : after_;
    while (sums.at_panel.size() <= k) {
      const std::size_t next = sums.at_panel.size();                      // panel next - 1 is missing
      if (std::isnan(sums.at_panel.back())) return sums.at_panel.back();  // and so are all later panels
      const double panel =
          integrate(t0_ + direction * begin_of(next - 1), t0_ + direction * begin_of(next), sums.evaluations);
      const double old = sums.at_panel.back();
      const double corrected = panel - sums.lost;
      const double sum = old + corrected;
      sums.lost = (sum - old) - corrected;
      sums.at_panel.push_back(sum);
    }
    return sums.at_panel[k];
  }

  struct Sums {
    std::vector<double> at_panel{0.0};
    double lost = 0.0;
    std::size_t evaluations = 0;  ///< spent on the panels so far
  };

  Law integrand_;
  double t0_;
  mutable std::mutex mutex_;  // guards the sums; nested integrals lock inwards only, so there is no cycle
  mutable Sums before_;
  mutable Sums after_;
};

}  // namespace

double eval_quadrature(const std::function<double(double)>& f, double a, double b) {
  const Estimate whole = eval_rule(f, a, b);
  Adaptive adaptive{f, whole.magnitude, 2.0 * eps * whole.magnitude};
  return adaptive.refine(a, b, whole, 0);
}

Law make_quadrature_integral(const Law& integrand, double t0) {
  return Law{std::make_shared<QuadratureIntegral>(integrand, t0)};
}

}  // namespace bough::laws
