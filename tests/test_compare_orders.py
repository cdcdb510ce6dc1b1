"""Orders of convergence and limits of series whose order is known."""

import numpy as np
import pytest

from pantograph_fem.compare.orders import orders_of_errors, orders_of_values, richardson_limit

HALVED = np.array([8.0, 4.0, 2.0, 1.0])
UNEVEN = np.array([9.0, 5.0, 2.0, 1.9])


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 3.7])
@pytest.mark.parametrize("h", [HALVED, UNEVEN], ids=["halved", "uneven"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_errors_that_are_a_power_have_its_order(h, order, sign):
    orders = orders_of_errors(h, sign * 0.3 * h**order)
    assert np.isnan(orders[0])
    np.testing.assert_allclose(orders[1:], order, rtol=1e-12)


def test_an_error_that_is_zero_or_unknown_has_no_order():
    orders = orders_of_errors(HALVED, [4.0, np.nan, 1.0, 0.0])
    assert np.isnan(orders).all()
    orders = orders_of_errors([4.0, 2.0, 1.0], [0.0, 4.0, 2.0])
    assert np.isnan(orders[:2]).all()
    assert orders[2] == pytest.approx(1.0)


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 3.7])
@pytest.mark.parametrize("ratio", [2.0, 3.0, 1.2])
def test_three_values_at_a_constant_ratio_give_order_and_limit(order, ratio):
    h = ratio ** np.arange(4.0, -1.0, -1.0)
    values = 5.0 - 0.01 * h**order
    orders = orders_of_values(h, values)
    assert np.isnan(orders[:2]).all()
    np.testing.assert_allclose(orders[2:], order, rtol=1e-9)
    limit = richardson_limit(h, values)
    assert limit.value == pytest.approx(5.0, rel=1e-12)
    assert limit.order == pytest.approx(order, rel=1e-9)


def test_parameters_rounded_to_a_few_digits_still_have_a_constant_ratio():
    h = np.array([9.6167, 4.8083, 2.4042])
    assert orders_of_values(h, h**2)[2] == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize(
    ("h", "values"),
    [
        (UNEVEN, UNEVEN**2),
        (HALVED, [1.0, 3.0, 2.0, 2.5]),
        (HALVED, [1.0, 1.0, 1.0, 1.0]),
        (HALVED, [2.0, 1.0, 1.0 + 2e-13, 1.0 + 1e-13]),
        ([2.0, 1.0], [2.0, 1.0]),
        ([], []),
    ],
    ids=["uneven", "to and fro", "constant", "rounding", "two", "none"],
)
def test_without_ratio_or_convergence_there_is_no_order_and_no_limit(h, values):
    assert np.isnan(orders_of_values(h, values)).all()
    assert richardson_limit(h, values) is None


def test_a_series_that_diverges_has_no_limit():
    values = HALVED**-1.0
    assert orders_of_values(HALVED, values)[-1] == pytest.approx(-1.0)
    assert richardson_limit(HALVED, values) is None
