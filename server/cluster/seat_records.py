"""The record of the person whose seat it is, as it was written last."""

import structlog

from esplanade.server.cluster.person_record import PersonRecord, RecordError, decode_record
from esplanade.server.cluster.seats import ClusterSeat

log = structlog.get_logger(__name__)


def record_in(seat: ClusterSeat) -> PersonRecord:
    """The record in a seat; an empty one where it cannot be read, which is logged."""
    try:
        return decode_record(seat.state)
    except RecordError as error:
        log.warning("a seat cannot be read", person=seat.person, error=str(error))
        return PersonRecord()
