#include "rt_core/inverse_kinematics/ipopt_program.hpp"

#include <HSLLoader.h>

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <thread>

#include "rt_core/inverse_kinematics/ipopt_clock.hpp"
#include "rt_core/inverse_kinematics/ipopt_ma27.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr double kNoBound = 2e19;  // beyond Ipopt's infinity

std::span<const double> span_of(const Number* x, Index n) { return {x, static_cast<std::size_t>(n)}; }

// The formulation in Ipopt's form: matrices are triplets, all places are taken.
class Nlp final : public Ipopt::TNLP {
 public:
  explicit Nlp(Formulation& formulation) : formulation_(formulation) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                    IndexStyleEnum& index_style) override {
    n = formulation_.variable_count();
    m = formulation_.equation_count();
    jacobian_entries = n * m;
    hessian_entries = n * (n + 1) / 2;
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* c_lower, Number* c_upper) override {
    for (Index i = 0; i < n; ++i) {
      lower[i] = std::max(formulation_.chain().lower()[static_cast<std::size_t>(i)], -kNoBound);
      upper[i] = std::min(formulation_.chain().upper()[static_cast<std::size_t>(i)], kNoBound);
    }
    std::fill_n(c_lower, m, 0.0);
    std::fill_n(c_upper, m, 0.0);
    return true;
  }

  bool get_starting_point(Index n, bool init_x, Number* x, bool init_z, Number* z_lower, Number* z_upper, Index m,
                          bool init_lambda, Number* lambda) override {
    if (init_x) std::copy_n(formulation_.problem().start.begin(), n, x);
    if (init_z) {
      std::fill_n(z_lower, n, 0.0);
      std::fill_n(z_upper, n, 0.0);
    }
    if (init_lambda) std::fill_n(lambda, m, 0.0);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool /*new_x*/, Number& value) override {
    value = formulation_.objective(span_of(x, n));
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool /*new_x*/, Number* gradient) override {
    const Gradient g = formulation_.objective_gradient(span_of(x, n));
    std::copy_n(g.data(), n, gradient);
    return g.allFinite();
  }

  bool eval_g(Index n, const Number* x, bool /*new_x*/, Index /*m*/, Number* c) override {
    formulation_.equations(span_of(x, n), c);
    return true;
  }

  bool eval_jac_g(Index n, const Number* x, bool /*new_x*/, Index m, Index /*entries*/, Index* rows, Index* columns,
                  Number* values) override {
    for (Index row = 0; row < m; ++row) {
      if (values != nullptr) {
        const Gradient g = formulation_.equation_gradient(span_of(x, n), row);
        std::copy_n(g.data(), n, values + row * n);
        continue;
      }
      std::fill_n(rows + row * n, n, row);
      for (Index column = 0; column < n; ++column) columns[row * n + column] = column;
    }
    return true;
  }

  bool eval_h(Index n, const Number* x, bool /*new_x*/, Number factor, Index /*m*/, const Number* lambda,
              bool /*new_lambda*/, Index /*entries*/, Index* rows, Index* columns, Number* values) override {
    Hessian h;
    if (values != nullptr) h = formulation_.lagrangian_hessian(span_of(x, n), factor, lambda);
    Index k = 0;
    for (Index column = 0; column < n; ++column) {
      for (Index row = column; row < n; ++row, ++k) {
        if (values != nullptr) {
          values[k] = h(row, column);
        } else {
          rows[k] = row;
          columns[k] = column;
        }
      }
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number value, Number, Number, Number, Number,
                             Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    // Another start is better than a search for a point that merely meets the equations.
    return mode == Ipopt::RegularMode && formulation_.go_on(iteration, value);
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number value, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    formulation_.finish(span_of(x, n), value);
  }

 private:
  Formulation& formulation_;
};

// For the whole process: Ipopt would search a shared library with MA27 at the first use, unless it is disabled.
void use_dense_factorisation() {
  static std::once_flag once;
  std::call_once(once, [] { LSL_setMA27(cellmirror_ma27ad, cellmirror_ma27bd, cellmirror_ma27cd, cellmirror_ma27id); });
}

std::mutex& mumps_mutex() {
  static std::mutex mutex;
  return mutex;
}

HessianChoice choice_of(IpoptSettings::Hessian hessian) {
  switch (hessian) {
    case IpoptSettings::Hessian::exact:
      return HessianChoice::exact;
    case IpoptSettings::Hessian::gauss_newton:
      return HessianChoice::gauss_newton;
    case IpoptSettings::Hessian::by_distance:
      break;
  }
  return HessianChoice::by_distance;
}

}  // namespace

struct IpoptProgram::State {
  State(const kinematics::Chain& chain, Objective objective_in, const IpoptSettings& settings_in)
      : formulation(chain, objective_in, choice_of(settings_in.hessian)),
        objective(objective_in),
        settings(settings_in) {}

  void build();
  void optimise(double tolerance);

  Formulation formulation;
  Objective objective;
  IpoptSettings settings;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application;
  Ipopt::SmartPtr<Ipopt::TNLP> nlp;
  std::thread::id thread;
  Index equations = 0;
  bool used = false;  // the application has solved this program before and keeps its structure
};

void IpoptProgram::State::build() {
  application = new Ipopt::IpoptApplication(false);
  nlp = new Nlp(formulation);
  thread = std::this_thread::get_id();
  equations = formulation.equation_count();
  used = false;

  Ipopt::OptionsList& options = *application->Options();
  options.SetIntegerValue("print_level", 0);
  options.SetStringValue("sb", "yes");
  const bool dense = settings.linear_solver == IpoptSettings::LinearSolver::dense;
  options.SetStringValue("linear_solver", dense ? "ma27" : "mumps");
  options.SetStringValue("linear_system_scaling", "none");  // the dense factorisation equilibrates internally
  options.SetStringValue("nlp_scaling_method", "none");
  options.SetStringValue("fast_step_computation", "yes");  // such small systems need no check of their solution
  options.SetNumericValue("bound_relax_factor", 0.0);      // limits are limits
  options.SetNumericValue("bound_push", 1e-4);
  options.SetNumericValue("bound_frac", 1e-4);
  options.SetNumericValue("mu_init", objective == Objective::squared_error ? 1e-10 : 1e-8);
  options.SetIntegerValue("acceptable_iter", 0);
  options.SetIntegerValue("max_iter", 1000);  // the formulation stops earlier
  application->Initialize("");                // no options file
}

void IpoptProgram::State::optimise(double tolerance) {
  constexpr double kLocalMinimum = 1e-10;
  constexpr double kSecondary = 1e-5;  // of the secondary objective's gradient (rad)
  // Ipopt's tolerance covers equations as well; theirs must be below the task's.
  const double tol = objective == Objective::squared_error ? kLocalMinimum : std::min(kSecondary, 0.5 * tolerance);
  application->Options()->SetNumericValue("tol", tol);
  if (used) {
    application->ReOptimizeTNLP(nlp);
  } else {
    application->OptimizeTNLP(nlp);
    used = true;
  }
}

IpoptProgram::IpoptProgram(const kinematics::Chain& chain, Objective objective, const IpoptSettings& settings)
    : state_(std::make_unique<State>(chain, objective, settings)) {
  use_idle_clocks();
  if (settings.linear_solver == IpoptSettings::LinearSolver::dense) use_dense_factorisation();
}

IpoptProgram::~IpoptProgram() = default;

Run IpoptProgram::run(const Problem& problem) {
  State& s = *state_;
  s.formulation.start(problem);
  std::unique_lock<std::mutex> lock;
  if (s.settings.linear_solver == IpoptSettings::LinearSolver::mumps) lock = std::unique_lock(mumps_mutex());
  try {
    const bool fits = s.thread == std::this_thread::get_id() && s.equations == s.formulation.equation_count();
    if (!Ipopt::IsValid(s.application) || !fits) s.build();
    s.optimise(problem.tolerance);
  } catch (...) {  // not caught by Ipopt: rebuild the next time
    s.application = nullptr;
  }
  return s.formulation.run();
}

}  // namespace cellmirror::inverse_kinematics
