"""State of the application, which every address is given."""

from __future__ import annotations

from moyai.app.documents import Documents
from moyai.app.folder import Folder
from moyai.app.jobs import Jobs
from moyai.app.pins import Run
from moyai.app.security import Secrets
from moyai.app.worker import DraftWorker
from moyai.language import require_language


class App:
    """State of one start: the folder, open cases, jobs, the process of the drafts.

    Parameters
    ----------
    folder : Folder
    run : callable
        Runs a case; a function of a module.
    secrets_ : Secrets
    first : str
        Case file that the page opens at once, relative to the folder; empty for the gallery.
    language : str
        Of the page and its messages, and of reports whose case names none.
    """

    def __init__(self, folder: Folder, run: Run, secrets_: Secrets, first: str = "", language: str = "en") -> None:
        self.folder = folder
        self.secrets = secrets_
        self.first = first
        self.language = require_language(language)
        self.documents = Documents(folder)
        self.jobs = Jobs(run, folder=folder)
        self.worker = DraftWorker(run, language)
