"""Steps as they are drawn: key poses, the curves through them, and how one step joins the next."""
