MODULE Pallet
  CONST num pitch:=120;
  CONST robtarget place0:=[[500,-200,150],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS speeddata slow:=[50,100,5000,1000];
  VAR robtarget place;
  VAR num placed;

  PROC main()
    FOR row FROM 0 TO 1 DO
      FOR column FROM 0 TO 2 DO
        place:=Offs(place0,row*pitch,column*pitch,0);
        put;
      ENDFOR
    ENDFOR
    IF placed=6 TPWrite "pallet full";
  ENDPROC

  PROC put()
    MoveJ Offs(place,0,0,100),v1000,z20,tool0;
    MoveL place,slow,fine,tool0;
    Reset do1;
    MoveL Offs(place,0,0,100),v200,z20,tool0;
    placed:=placed+1;
  ENDPROC
ENDMODULE
