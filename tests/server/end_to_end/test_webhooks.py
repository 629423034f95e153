"""Webhooks of a real server that is killed: few here, a thousand in the long measurement."""

from tests.server.webhook_deliveries import deliveries, violations


def test_each_state_comes_at_least_once_with_one_id_in_order():
    figures = deliveries(jobs=14, kills=1)
    assert figures["states"] >= 3 * 14 and violations({"few": figures}) == []
