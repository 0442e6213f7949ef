// Objects that one thread owns and another one uses for a while: the owner lends, the user gives back, the owner frees.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/real_time.hpp"

namespace cellmirror {

class Lender;

namespace detail {

// One loan. Made and freed by the owner's thread.
struct Loan {
  std::shared_ptr<const void> object;  // keeps it alive; only the owner's thread copies or drops it
  Lender* lender = nullptr;
  std::atomic<Loan*> next{nullptr};  // of the queue of what came back
};

}  // namespace detail

// The right to use an object of the owner until the lease ends. Moves from thread to thread through a queue; one thread
// at a time has it. Ending it is wait-free and frees nothing, so the tick may hold leases and drop them.
template <class T>
class Lease {
 public:
  Lease() = default;  // of nothing
  Lease(Lease&& other) noexcept
      : object_(std::exchange(other.object_, nullptr)), loan_(std::exchange(other.loan_, nullptr)) {}
  Lease& operator=(Lease&& other) noexcept {
    if (this != &other) {
      give_back();
      object_ = std::exchange(other.object_, nullptr);
      loan_ = std::exchange(other.loan_, nullptr);
    }
    return *this;
  }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;
  ~Lease() { give_back(); }

  [[nodiscard]] T* get() const CELL_RT { return object_; }
  [[nodiscard]] T& operator*() const CELL_RT { return *object_; }
  [[nodiscard]] T* operator->() const CELL_RT { return object_; }
  [[nodiscard]] explicit operator bool() const CELL_RT { return object_ != nullptr; }

  // Ends the lease; it is one of nothing then.
  void give_back() CELL_RT;

 private:
  friend class Lender;
  Lease(T* object, detail::Loan* loan) : object_(object), loan_(loan) {}

  T* object_ = nullptr;
  detail::Loan* loan_ = nullptr;
};

// The owner's side. Outlives all its leases. One thread, but for what leases do.
//
// What comes back passes through a linked queue with any number of producers and one consumer (Vyukov, "Intrusive MPSC
// node-based queue", 1024cores.net): a producer does one exchange and one store. The loans are its nodes, so it is
// never full and takes no memory. There may be two producers at a time: the tick, and the owner's thread itself where
// a command with a lease was not taken.
class Lender {
 public:
  Lender() = default;
  Lender(const Lender&) = delete;
  Lender& operator=(const Lender&) = delete;
  ~Lender() {
    collect();
    CELLMIRROR_EXPECTS(outstanding_ == 0);
  }

  // Of a null pointer: a lease of nothing. The object lives at least until the lease has come back and was collected.
  template <class T>
  [[nodiscard]] Lease<T> lend(std::shared_ptr<T> object) {
    if (object == nullptr) return {};
    T* const lent = object.get();
    auto* const loan = new detail::Loan{std::move(object), this, nullptr};
    ++outstanding_;
    return Lease<T>(lent, loan);
  }

  // Frees what came back. Returns how many leases that were.
  std::size_t collect() {
    std::size_t count = 0;
    while (detail::Loan* const loan = pop()) {
      delete loan;
      ++count;
    }
    outstanding_ -= count;
    return count;
  }

  // Leases that have not been collected yet.
  [[nodiscard]] std::size_t outstanding() const { return outstanding_; }

 private:
  template <class T>
  friend class Lease;

  // Any thread.
  void push(detail::Loan* loan) CELL_RT {
    loan->next.store(nullptr, std::memory_order_relaxed);
    // Acquire and release: orders the producers; the one before has cleared the `next` that is written below.
    detail::Loan* const previous = newest_.exchange(loan, std::memory_order_acq_rel);
    // Release: pairs with the acquire in pop(); the user's last access to the object is over before it is freed.
    previous->next.store(loan, std::memory_order_release);
  }

  // Null where nothing came back, or where the newest push is not complete yet.
  detail::Loan* pop() {
    detail::Loan* oldest = oldest_;
    detail::Loan* next = oldest->next.load(std::memory_order_acquire);
    if (oldest == &stub_) {
      if (next == nullptr) return nullptr;
      oldest_ = oldest = next;
      next = oldest->next.load(std::memory_order_acquire);
    }
    if (next == nullptr) {
      // It may be the last one: it can be taken out only when another node is behind it.
      if (oldest != newest_.load(std::memory_order_acquire)) return nullptr;
      push(&stub_);
      next = oldest->next.load(std::memory_order_acquire);
      if (next == nullptr) return nullptr;
    }
    oldest_ = next;
    return oldest;
  }

  detail::Loan stub_;
  alignas(64) std::atomic<detail::Loan*> newest_{&stub_};
  alignas(64) detail::Loan* oldest_ = &stub_;  // the owner's own
  std::size_t outstanding_ = 0;                // the owner's own
};

template <class T>
void Lease<T>::give_back() CELL_RT {
  object_ = nullptr;
  if (detail::Loan* const loan = std::exchange(loan_, nullptr)) loan->lender->push(loan);
}

}  // namespace cellmirror
