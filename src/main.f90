program gudgeon
  implicit none
end program gudgeon
