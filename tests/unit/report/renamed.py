"""What of a real result could be renamed without an error when its report is made."""

from moyai.core.kinds import vocabulary_of
from moyai.core.results import Result


def unmissed(result: Result) -> set[str]:
    """Return the variables of all groups that the vocabulary would not miss under another name."""
    own, found = vocabulary_of(result.tree), set()
    assert own is not None
    for node in result.tree.subtree:
        if own.at(node.path) is own:
            data = node.to_dataset(inherit=False)
            renamed = {name: data.rename({name: f"{name}_of_old"}) for name in data.data_vars}
            found |= {str(name) for name, changed in renamed.items() if not own.absent(node.path, changed)}
    return found
