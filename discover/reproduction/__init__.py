"""The paper reproduced and questioned: its tables, its figures' curves, its claims."""

from discover.reproduction.claims import Claim, all_claims
from discover.reproduction.comparison import IdentificationRow, StandIn, compare_identification
from discover.reproduction.figures import Curve, Panel, PaperFigure, paper_figures
from discover.reproduction.orders import OrderCurve, OrderPoint, order_curve, order_points
from discover.reproduction.paper import IDENTIFIED, M1, M2, M3, Condition, Identified
from discover.reproduction.result import Reproduction, reproduce
from discover.reproduction.tables import critical_frequencies, table_1, table_2, table_3

__all__ = [
    "IDENTIFIED",
    "M1",
    "M2",
    "M3",
    "Claim",
    "Condition",
    "Curve",
    "Identified",
    "IdentificationRow",
    "OrderCurve",
    "OrderPoint",
    "PaperFigure",
    "Panel",
    "Reproduction",
    "StandIn",
    "all_claims",
    "compare_identification",
    "critical_frequencies",
    "order_curve",
    "order_points",
    "paper_figures",
    "reproduce",
    "table_1",
    "table_2",
    "table_3",
]
