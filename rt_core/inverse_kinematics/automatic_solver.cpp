#include "rt_core/inverse_kinematics/automatic_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "rt_core/inverse_kinematics/request.hpp"
#include "rt_core/inverse_kinematics/search.hpp"
#include "rt_core/inverse_kinematics/seed_table.hpp"

namespace cellmirror::inverse_kinematics {

namespace {

class AutomaticSolver final : public Solver {
 public:
  explicit AutomaticSolver(const kinematics::Chain& chain) : chain_(chain), table_(chain_) {}

  [[nodiscard]] Result<Answer> solve(const Request& asked) override {
    const Result<Request> good = checked(asked, chain_);
    if (!good) return std::unexpected(good.error());
    Search search(chain_, *good);
    from_table(search, *good);
    at_random(search, *good);
    return search.finish();
  }

 private:
  void from_table(Search& search, const Request& request) {
    std::array<Seed, SeedTable::kMostSeeds> seeds;
    const std::size_t count = table_.find(request.X_BG, request.present, {seeds.data(), seeds_});
    std::size_t good = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (search.descend(seeds[i].q, iter_, FoundBy::seed_table)) ++good;
      if (good >= tries_) return;
      if (search.out_of_time()) return;
    }
  }
  void at_random(Search& search, const Request& request) {
    if (search.found() >= request.max_solutions) return;
    std::mt19937_64 random(1);
    for (int start = 0; start < 1000; ++start) {
      JointValues q{};
      for (std::size_t i = 0; i < chain_.variable_count(); ++i) {
        const bool bounded = std::isfinite(chain_.lower()[i]);
        q[i] = std::uniform_real_distribution<double>(bounded ? chain_.lower()[i] : -std::numbers::pi,
                                                      bounded ? chain_.upper()[i] : std::numbers::pi)(random);
      }
      if (search.descend(q, 40, FoundBy::fast) && search.found() >= request.max_solutions) return;
      if (search.out_of_time()) return;
    }
  }

  kinematics::Chain chain_;
  SeedTable table_;
  std::size_t tries_ = 1;
  std::size_t seeds_ = 16;
  int iter_ = 20;
};

}  // namespace

std::unique_ptr<Solver> make_automatic_solver(const kinematics::Chain& chain) {
  return std::make_unique<AutomaticSolver>(chain);
}

}  // namespace cellmirror::inverse_kinematics
