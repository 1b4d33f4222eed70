from __future__ import annotations

import multiprocessing.reduction as crossing
from io import BytesIO

from coopera.core.errors import BudgetError, CooperaError, ModelOutputError


def test_an_error_crosses_to_another_process_whole() -> None:
    for err in (BudgetError("spent"), ModelOutputError("judge/tasks", "no", "it is prose")):
        parcel = BytesIO()
        crossing.dump(err, parcel)
        there: CooperaError = crossing.ForkingPickler.loads(parcel.getvalue())
        assert (type(there), str(there), vars(there)) == (type(err), str(err), vars(err))
