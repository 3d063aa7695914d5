"""The physics report: measured against what theory knows, on the user's own machine, through the public API only.

    report = accuray.verify.run(quick=True)
    print(report.table())

Chapters: C1 direct light, C2 enclosures, C3 energy, C4 smooth interfaces, films and metals, C5 refraction, C7 cameras,
C8 spectra and colour. A number passes when it lies within four standard errors (plus 1e-5 for arithmetic) of the closed
form and the standard error is at most 0.1 % of it; a noisier measurement has no power and does not pass.
"""

from accuray.verify.case import Case, Row
from accuray.verify.report import Report
from accuray.verify.runner import all_cases, run

__all__ = ["Case", "Report", "Row", "all_cases", "run"]
