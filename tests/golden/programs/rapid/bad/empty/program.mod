
! nothing
