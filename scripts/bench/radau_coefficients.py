#!/usr/bin/env python3
"""Writes src/ode/radau/radau_coefficients.f90: the Radau IIA formulas of 3, 5 and 7 stages.

Nodes are the roots of the right Radau polynomial, A the collocation matrix, and T the real matrix that brings A^-1 to
block-diagonal form (Hairer & Wanner 1996, IV.8), all computed in 60-digit arithmetic. Needs mpmath (PyPI).

    python3 scripts/bench/radau_coefficients.py > src/ode/radau/radau_coefficients.f90
"""
from mpmath import eig, im, inverse, lu_solve, matrix, mp, mpf, nstr, polyroots, re

mp.dps = 60


def poly_derivative(p):
    n = len(p) - 1
    return [c * (n - i) for i, c in enumerate(p[:-1])]


def radau_nodes(s):
    """Roots of d^(s-1)/dx^(s-1) [x^(s-1) (x-1)^s]."""
    p = [mpf(1)]
    for root, times in ((0, s - 1), (1, s)):
        for _ in range(times):
            p = [a - root * b for a, b in zip(p + [mpf(0)], [mpf(0)] + p)]
    for _ in range(s - 1):
        p = poly_derivative(p)
    return sorted(re(r) for r in polyroots(p, maxsteps=500, extraprec=400))


def formulas(s):
    c = radau_nodes(s)
    powers = matrix(s, s)
    integrals = matrix(s, s)
    for i in range(s):
        for j in range(s):
            powers[i, j] = c[i] ** j
            integrals[i, j] = c[i] ** (j + 1) / (j + 1)
    a = integrals * inverse(powers)
    a_inverse = inverse(a)
    values, vectors = eig(a_inverse)
    real = [i for i in range(s) if abs(im(values[i])) < mpf(10) ** -40]
    pairs = sorted((i for i in range(s) if im(values[i]) > mpf(10) ** -40), key=lambda i: im(values[i]))
    assert len(real) == 1 and 1 + 2 * len(pairs) == s
    gamma = re(values[real[0]])
    t = matrix(s, s)
    for row in range(s):
        t[row, 0] = re(vectors[row, real[0]] / vectors[s - 1, real[0]])
        for k, i in enumerate(pairs):
            scaled = vectors[row, i] / vectors[s - 1, i]
            t[row, 1 + 2 * k] = re(scaled)
            t[row, 2 + 2 * k] = im(scaled)
    # with T = (real part, imaginary part): A^-1 T = T [[alpha, beta], [-beta, alpha]]
    t_inverse = inverse(t)
    alphas = [re(values[i]) for i in pairs]
    betas = [im(values[i]) for i in pairs]
    block = t_inverse * a_inverse * t
    check = matrix(s, s)
    check[0, 0] = gamma
    for k in range(len(pairs)):
        j = 1 + 2 * k
        check[j, j] = check[j + 1, j + 1] = alphas[k]
        check[j, j + 1] = betas[k]
        check[j + 1, j] = -betas[k]
    assert max(abs(x) for x in block - check) < mpf(10) ** -40
    # error estimate: y_hat = y_0 + h (gamma0 f_0 + sum b_hat f) of order s, as a combination of the z = h A f
    gamma0 = 1 / gamma
    conditions = matrix(s, s)
    right = matrix(s, 1)
    for q in range(s):
        for j in range(s):
            conditions[q, j] = c[j] ** q
        right[q] = mpf(1) / (q + 1) - (gamma0 if q == 0 else 0)
    b_hat = lu_solve(conditions, right)
    e = [sum((b_hat[i] - a[s - 1, i]) * a_inverse[i, j] for i in range(s)) for j in range(s)]
    return c, a, t, t_inverse, gamma, alphas, betas, e


def number(x):
    return nstr(x, 25, strip_zeros=False, min_fixed=-5, max_fixed=40) + "_dp"


def listed(name, values, per_line=3):
    lines = []
    for i in range(0, len(values), per_line):
        lines.append("      " + ", ".join(number(v) for v in values[i:i + per_line]))
    return f"    formula%{name} = [ &\n" + ", &\n".join(lines) + "]\n"


def columns(m):
    return [m[i, j] for j in range(m.cols) for i in range(m.rows)]


HEADER = """!> The Radau IIA formulas of 3, 5 and 7 stages (orders 5, 9, 13), stiffly accurate collocation at the right Radau points.
!> Written by scripts/bench/radau_coefficients.py, which computes them in 60-digit arithmetic; not edited by hand.
module radau_coefficients
  use kinds, only: dp
  implicit none
  private
  public :: radau_formula_t, radau_formula, most_stages

  integer, parameter :: most_stages = 7

  !> One formula of s stages. A^-1 T = T Lambda with Lambda = diag(gamma, [[alpha, beta], [-beta, alpha]], ...).
  type :: radau_formula_t
    integer :: stages = 0
    real(dp), allocatable :: c(:)          !! nodes in (0, 1], (s)
    real(dp), allocatable :: a(:, :)       !! collocation matrix, (s, s)
    real(dp), allocatable :: t(:, :)       !! to the stages from the decoupled unknowns, (s, s)
    real(dp), allocatable :: t_inverse(:, :)
    real(dp) :: gamma = 0                  !! real eigenvalue of A^-1
    real(dp), allocatable :: alpha(:)      !! real parts of the complex pairs, ((s-1)/2)
    real(dp), allocatable :: beta(:)       !! their imaginary parts
    real(dp), allocatable :: e(:)          !! error estimate from the stage increments, besides h f_0/gamma, (s)
  end type radau_formula_t

contains

  !> The formula of 3, 5 or 7 stages.
  pure type(radau_formula_t) function radau_formula(stages) result(formula)
    integer, intent(in) :: stages
    select case (stages)
    case (3)
      call stages_3(formula)
    case (5)
      call stages_5(formula)
    case default
      call stages_7(formula)
    end select
    formula%stages = size(formula%c)
  end function radau_formula
"""


def main():
    print(HEADER, end="")
    for s in (3, 5, 7):
        c, a, t, t_inverse, gamma, alphas, betas, e = formulas(s)
        print(f"\n  pure subroutine stages_{s}(formula)\n    type(radau_formula_t), intent(inout) :: formula")
        print(listed("c", c), end="")
        for name, m in (("a", a), ("t", t), ("t_inverse", t_inverse)):
            text = listed(name, columns(m)).replace(" = [ &", " = reshape([ &")
            print(text.rstrip("\n")[:-1] + f"], [{s}, {s}])")
        print(f"    formula%gamma = {number(gamma)}")
        print(listed("alpha", alphas), end="")
        print(listed("beta", betas), end="")
        print(listed("e", e), end="")
        print(f"  end subroutine stages_{s}")
    print("end module radau_coefficients")


if __name__ == "__main__":
    main()
